import {
  type Color,
  DynamicDrawUsage,
  Float32BufferAttribute,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
  ShaderMaterial,
  Vector2,
} from 'three';

/** Many straight lines, some pixels wide, in one draw call. Every frame: `begin`, `add` each, `end`. */
export class Lines {
  readonly mesh: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  private from!: InstancedBufferAttribute;
  private to!: InstancedBufferAttribute;
  private color!: InstancedBufferAttribute;
  private fade!: InstancedBufferAttribute;
  private count = 0;

  constructor(onTop: boolean) {
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute('position', new Float32BufferAttribute([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0], 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.mesh = new Mesh(geometry, material(onTop));
    this.mesh.frustumCulled = false;
    this.grow(512);
  }

  /** The drawing's size in CSS pixels, for the width of lines. */
  resize(width: number, height: number): void {
    (this.mesh.material.uniforms['viewport']?.value as Vector2).set(width, height);
  }

  begin(): void {
    this.count = 0;
  }

  /** From `a` to `b` (x, y, z in metres), as opaque as said at both ends, `width` CSS pixels wide. */
  add(a: ArrayLike<number>, b: ArrayLike<number>, color: Color, width: number, fadeA = 1, fadeB = fadeA): void {
    if (this.count === this.from.count) this.grow(this.from.count * 2);
    const at = this.count;
    this.from.setXYZ(at, a[0] ?? 0, a[1] ?? 0, a[2] ?? 0);
    this.to.setXYZ(at, b[0] ?? 0, b[1] ?? 0, b[2] ?? 0);
    this.color.setXYZ(at, color.r, color.g, color.b);
    this.fade.setXYZ(at, fadeA, fadeB, width);
    this.count += 1;
  }

  end(): void {
    this.mesh.geometry.instanceCount = this.count;
    this.mesh.visible = this.count > 0;
    for (const attribute of [this.from, this.to, this.color, this.fade]) {
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, 3 * this.count);
      attribute.needsUpdate = true;
    }
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }

  private grow(room: number): void {
    const wider = (name: string, before: InstancedBufferAttribute | undefined) => {
      const values = new Float32Array(3 * room);
      if (before) values.set(before.array);
      const attribute = new InstancedBufferAttribute(values, 3).setUsage(DynamicDrawUsage);
      this.mesh.geometry.setAttribute(name, attribute);
      return attribute;
    };
    this.from = wider('from', this.from);
    this.to = wider('to', this.to);
    this.color = wider('tint', this.color);
    this.fade = wider('fade', this.fade);
  }
}

function material(onTop: boolean): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: { viewport: { value: new Vector2(1, 1) } },
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    transparent: true,
    depthWrite: false,
    depthTest: !onTop,
  });
}

const VERTEX = /* glsl */ `
attribute vec3 from;
attribute vec3 to;
attribute vec3 tint;
attribute vec3 fade;
uniform vec2 viewport;
varying vec4 vColor;

void main() {
  vec4 a = modelViewMatrix * vec4(from, 1.0);
  vec4 b = modelViewMatrix * vec4(to, 1.0);
  // What lies behind the eye is cut where the eye begins to see.
  float near = -0.06;
  if (a.z > near && b.z > near) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  if (a.z > near) a = mix(b, a, (near - b.z) / (a.z - b.z));
  if (b.z > near) b = mix(a, b, (near - a.z) / (b.z - a.z));
  vec4 start = projectionMatrix * a;
  vec4 end = projectionMatrix * b;
  vec2 way = (end.xy / end.w - start.xy / start.w) * viewport;
  float length = max(length(way), 0.0001);
  vec2 side = vec2(-way.y, way.x) / length;
  vec4 at = mix(start, end, position.x);
  at.xy += side * position.y * fade.z / viewport * at.w;
  gl_Position = at;
  vColor = vec4(tint, mix(fade.x, fade.y, position.x));
}
`;

const FRAGMENT = /* glsl */ `
varying vec4 vColor;
void main() {
  gl_FragColor = vColor;
  #include <colorspace_fragment>
}
`;
