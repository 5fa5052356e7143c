import { BackSide, Color, Mesh, type Object3D, ShaderMaterial, SphereGeometry, type Vector3 } from 'three';
import type { Look } from './theme';

/** What is behind everything: the horizon's colour, which grows into the zenith's. */
export class Sky {
  private readonly mesh: Mesh<SphereGeometry, ShaderMaterial>;

  constructor(parent: Object3D) {
    // The upper half and a little more: the ground covers the rest.
    const dome = new SphereGeometry(120, 32, 12, 0, 2 * Math.PI, 0, Math.PI * 0.56).rotateX(Math.PI / 2);
    const material = new ShaderMaterial({
      uniforms: { zenith: { value: new Color() }, horizon: { value: new Color() } },
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: BackSide,
      depthTest: false,
      depthWrite: false,
    });
    this.mesh = new Mesh(dome, material);
    this.mesh.renderOrder = -20;
    this.mesh.frustumCulled = false;
    parent.add(this.mesh);
  }

  wear(look: Look): void {
    (this.mesh.material.uniforms['zenith']?.value as Color).copy(look.zenith);
    (this.mesh.material.uniforms['horizon']?.value as Color).copy(look.horizon);
  }

  /** The sky is around whoever looks. */
  surround(eye: Vector3): void {
    this.mesh.position.copy(eye);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

const VERTEX = /* glsl */ `
varying float vHeight;
void main() {
  vHeight = normalize(position).z;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
`;

const FRAGMENT = /* glsl */ `
uniform vec3 zenith;
uniform vec3 horizon;
varying float vHeight;
void main() {
  float grain = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) - 0.5;
  gl_FragColor = vec4(mix(horizon, zenith, smoothstep(0.0, 0.55, vHeight)) + grain / 1600.0, 1.0);
  #include <colorspace_fragment>
}
`;
