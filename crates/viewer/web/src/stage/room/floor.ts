import { CircleGeometry, Color, Mesh, MeshBasicMaterial, type Object3D, ShadowMaterial, Shape, ShapeGeometry, Vector2, type Vector3 } from 'three';
import type { Look } from './theme';

/** The ground at z = 0: lines in metres that fade out with the distance, shadows, and the red triangle that marks +X. */
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
    this.triangle = new Mesh(triangle(), new MeshBasicMaterial({ color: '#e5403f', toneMapped: false, depthWrite: false }));
    this.triangle.position.z = 0.001;
    this.triangle.renderOrder = -9;
    parent.add(this.ground, this.triangle);
  }

  /** Takes the colours of a theme. */
  wear(look: Look): void {
    const { ground, horizon, line, shade, strength } = this.uniforms;
    ground.value.copy(look.floor);
    horizon.value.copy(look.horizon);
    line.value.copy(look.line);
    shade.value.copy(look.shade);
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
    const material = new ShadowMaterial({ transparent: false, depthWrite: false, depthTest: false, toneMapped: false, fog: false });
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, this.uniforms);
      shader.vertexShader = shader.vertexShader
        .replace('void main() {', 'varying vec2 vGround;\nvoid main() {\nvGround = (modelMatrix * vec4(position, 1.0)).xy;');
      shader.fragmentShader = shader.fragmentShader
        .replace('void main() {', `${GRID}\nvoid main() {`)
        .replace(/gl_FragColor = vec4\( color.*\n/, 'gl_FragColor = vec4(paint(getShadowMask()), 1.0);\n');
    };
    return material;
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

// Lines of a width in cells, thinned out where they would be thinner than a pixel.
float lines(vec2 at, float width) {
  vec2 step_ = max(fwidth(at), vec2(0.00001));
  vec2 drawn = clamp(vec2(width), step_, vec2(0.5));
  vec2 near = 1.0 - abs(fract(at) * 2.0 - 1.0);
  vec2 on = smoothstep(drawn + step_ * 1.4, drawn - step_ * 1.4, near) * clamp(width / drawn, 0.0, 1.0);
  on = mix(on, vec2(width), clamp(step_ * 2.0 - 1.0, 0.0, 1.0));
  return mix(on.x, 1.0, on.y);
}

vec3 paint(float lit) {
  float away = distance(vGround, centre) / reach;
  float near = 1.0 - smoothstep(0.0, 1.0, away);
  vec3 color = mix(horizon, ground, near * near);
  if (away < 1.0) {
    float grid = max(lines(vGround, 0.014) * 0.62, lines(vGround * 0.2, 0.005));
    color = mix(color, line, grid * near);
  }
  color = mix(color, shade, strength * (1.0 - lit) * near);
  // Half a step of the screen's colours: dark slopes would show bands otherwise.
  float grain = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) - 0.5;
  return color + grain / 1600.0;
}
`;
