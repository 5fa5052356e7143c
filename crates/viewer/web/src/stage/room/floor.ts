import {
  CircleGeometry,
  Color,
  Mesh,
  MeshBasicMaterial,
  type Object3D,
  ShadowMaterial,
  Shape,
  ShapeGeometry,
  Vector2,
  type Vector3,
} from 'three';
import { displayed } from './displayed';
import type { Look } from './theme';

/** The ground at z = 0: lines in metres that fade out in the distance, shadows, the red triangle that marks +X. */
export class Floor {
  private readonly uniforms = {
    centre: { value: new Vector2() },
    reach: { value: 12 },
    ground: { value: new Color() },
    horizon: { value: new Color() },
    line: { value: new Color() },
    shade: { value: new Color() },
    strength: { value: 0.5 },
  };
  private readonly ground: Mesh;
  private readonly triangle: Mesh;

  constructor(parent: Object3D) {
    this.ground = new Mesh(new CircleGeometry(EDGE, 48), this.material());
    this.ground.receiveShadow = true;
    // Drawn before everything and without depth, so that whoever is under the ground is seen nevertheless.
    this.ground.renderOrder = -10;
    this.triangle = new Mesh(
      triangle(),
      new MeshBasicMaterial({ color: '#e5403f', toneMapped: false, depthWrite: false }),
    );
    this.triangle.position.z = 0.001;
    this.triangle.renderOrder = -9;
    parent.add(this.ground, this.triangle);
  }

  /** Takes the colours of a theme. */
  wear(look: Look): void {
    const { ground, horizon, line, shade, strength } = this.uniforms;
    ground.value.copy(look.floor).convertLinearToSRGB();
    horizon.value.copy(look.horizon).convertLinearToSRGB();
    line.value.copy(look.line).convertLinearToSRGB();
    shade.value.copy(look.shade).convertLinearToSRGB();
    strength.value = look.shadow;
  }

  /** Puts the clear part of the floor where the interest is; it fades out at some times `radius`. */
  attend(centre: Vector3, radius: number): void {
    this.uniforms.centre.value.set(centre.x, centre.y);
    this.uniforms.reach.value = Math.min(Math.max(radius * 3.2, 9), EDGE * 0.9);
    // Whole metres, for the lines' sake: large coordinates would make them tremble.
    this.ground.position.set(Math.round(centre.x), Math.round(centre.y), 0);
  }

  dispose(): void {
    for (const mesh of [this.ground, this.triangle]) {
      mesh.geometry.dispose();
      (mesh.material as ShadowMaterial).dispose();
    }
  }

  private material(): ShadowMaterial {
    const material = new ShadowMaterial({
      transparent: false,
      depthWrite: false,
      depthTest: false,
      toneMapped: false,
      fog: false,
    });
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, this.uniforms);
      shader.vertexShader = shader.vertexShader.replace(
        'void main() {',
        'varying vec2 vGround;\nvoid main() {\nvGround = (modelMatrix * vec4(position, 1.0)).xy;',
      );
      shader.fragmentShader = shader.fragmentShader
        .replace('void main() {', `${GRID}\nvoid main() {`)
        .replace(/gl_FragColor = vec4\( color.*\n/, 'gl_FragColor = vec4(paint(getShadowMask()), 1.0);\n');
    };
    return displayed(material);
  }
}

/** How far the ground reaches in metres; it has faded into the horizon long before. */
const EDGE = 90;

/** Flat on the ground, its base at the origin, its tip at x = 0.3 m. */
function triangle(): ShapeGeometry {
  return new ShapeGeometry(new Shape([new Vector2(0, 0.09), new Vector2(0, -0.09), new Vector2(0.3, 0)]));
}

const GRID = /* glsl */ `
varying vec2 vGround;
uniform vec2 centre;
uniform float reach;
uniform vec3 ground;
uniform vec3 horizon;
uniform vec3 line;
uniform vec3 shade;
uniform float strength;

// How much of a pixel the lines cover half_ metres thick on both sides that are away metres from it. Lines
// thinner than a pixel are drawn a pixel wide and fainter.
float lines(vec2 away, float half_, vec2 step_) {
  vec2 wide = max(vec2(half_), step_ * 0.6);
  vec2 on = clamp((wide + 0.5 * step_ - away) / step_, 0.0, 1.0) * clamp(1.6 * half_ / step_, 0.0, 1.0);
  return max(on.x, on.y);
}

vec3 paint(float lit) {
  vec2 way = (vGround - centre) / reach;
  float near = max(1.0 - dot(way, way), 0.0);
  near *= near;
  vec3 color = mix(horizon, ground, near);
  vec2 step_ = max(fwidth(vGround), vec2(0.0001));
  vec2 metre = abs(fract(vGround + 0.5) - 0.5);
  vec2 fifth = abs(fract(vGround * 0.2 + 0.5) - 0.5) * 5.0;
  float grid = max(lines(metre, 0.007, step_) * 0.62, lines(fifth, 0.009, step_));
  color = mix(color, line, grid * near);
  return mix(color, shade, strength * (1.0 - lit) * near);
}
`;
