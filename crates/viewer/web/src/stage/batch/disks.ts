import {
  type Color,
  DynamicDrawUsage,
  Float32BufferAttribute,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
  ShaderMaterial,
} from 'three';

/** How a disk ends: a soft stain, or a thin ring. */
export type DiskEdge = 'soft' | 'ring';

/** Flat disks that lie level: shadows, contacts, marks on the ground. Every frame: `begin`, `add` each, `end`. */
export class Disks {
  readonly mesh: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  private place!: InstancedBufferAttribute;
  private tint!: InstancedBufferAttribute;
  private edge!: InstancedBufferAttribute;
  private count = 0;

  constructor() {
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute('position', new Float32BufferAttribute([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0], 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.mesh = new Mesh(
      geometry,
      new ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT, transparent: true, depthWrite: false }),
    );
    this.mesh.frustumCulled = false;
    this.grow(128);
  }

  begin(): void {
    this.count = 0;
  }

  add(x: number, y: number, z: number, radius: number, color: Color, opacity: number, edge: DiskEdge = 'soft'): void {
    if (this.count === this.place.count) this.grow(this.place.count * 2);
    this.place.setXYZW(this.count, x, y, z, radius);
    this.tint.setXYZW(this.count, color.r, color.g, color.b, opacity);
    this.edge.setX(this.count, edge === 'ring' ? 1 : 0);
    this.count += 1;
  }

  end(): void {
    this.mesh.geometry.instanceCount = this.count;
    this.mesh.visible = this.count > 0;
    for (const attribute of [this.place, this.tint, this.edge]) {
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, attribute.itemSize * this.count);
      attribute.needsUpdate = true;
    }
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }

  private grow(room: number): void {
    const wider = (name: string, size: number, before: InstancedBufferAttribute | undefined) => {
      const values = new Float32Array(size * room);
      if (before) values.set(before.array);
      const attribute = new InstancedBufferAttribute(values, size).setUsage(DynamicDrawUsage);
      this.mesh.geometry.setAttribute(name, attribute);
      return attribute;
    };
    this.place = wider('place', 4, this.place);
    this.tint = wider('tint', 4, this.tint);
    this.edge = wider('edge', 1, this.edge);
  }
}

const VERTEX = /* glsl */ `
attribute vec4 place;
attribute vec4 tint;
attribute float edge;
varying vec2 vAt;
varying vec4 vTint;
varying float vEdge;
void main() {
  vAt = position.xy;
  vTint = tint;
  vEdge = edge;
  gl_Position = projectionMatrix * viewMatrix * vec4(place.xyz + vec3(position.xy * place.w, 0.0), 1.0);
}
`;

const FRAGMENT = /* glsl */ `
varying vec2 vAt;
varying vec4 vTint;
varying float vEdge;
void main() {
  float out_ = length(vAt);
  float stain = smoothstep(1.0, 0.0, out_);
  float ring = smoothstep(0.74, 0.82, out_) * smoothstep(1.0, 0.93, out_);
  float alpha = vTint.a * mix(stain * stain, ring, vEdge);
  if (alpha < 0.004) discard;
  gl_FragColor = vec4(vTint.rgb, alpha);
  #include <colorspace_fragment>
}
`;
