import {
  type Color,
  DynamicDrawUsage,
  type InstancedBufferGeometry,
  InstancedBufferAttribute,
  type Material,
  Mesh,
  MeshDepthMaterial,
  type Quaternion,
  type Vector3,
} from 'three';
import type { Part } from '../body/part';
import { type Fineness, limbGeometry } from './limb_geometry';
import { drawLimbs } from './limb_shader';

/** Many limbs of one material in one draw call. Every frame: `begin`, `add` each, `end`. */
export class Limbs {
  readonly mesh: Mesh<InstancedBufferGeometry, Material>;
  private readonly geometry: InstancedBufferGeometry;
  private columns: Column[] = [];
  private count = 0;
  private room = 0;

  constructor(fineness: Fineness, material: Material) {
    this.geometry = limbGeometry(fineness);
    this.mesh = new Mesh(this.geometry, drawLimbs(material));
    this.mesh.customDepthMaterial = drawLimbs(new MeshDepthMaterial());
    this.mesh.frustumCulled = false;
    this.grow(256);
  }

  begin(): void {
    this.count = 0;
  }

  /** A part at a place: where it starts and how its axes are turned in the room. */
  add(part: Part, at: Vector3, turn: Quaternion, color: Color): void {
    const { start, end, caps } = part;
    this.put(
      at,
      part.length,
      turn,
      [start[0], start[1], end[0], end[1]],
      [part.bulge, part.bow, caps[0], caps[1]],
      color,
    );
  }

  /** A ball. */
  addBall(at: Vector3, radius: number, color: Color): void {
    this.put(at, 0, UPRIGHT, [radius, radius, radius, radius], [0, 0, radius, radius], color);
  }

  end(): void {
    this.geometry.instanceCount = this.count;
    this.mesh.visible = this.count > 0;
    for (const { attribute } of this.columns) {
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, this.count * attribute.itemSize);
      attribute.needsUpdate = true;
    }
  }

  dispose(): void {
    this.geometry.dispose();
    this.mesh.material.dispose();
    this.mesh.customDepthMaterial?.dispose();
  }

  private put(
    at: Vector3,
    length: number,
    turn: { x: number; y: number; z: number; w: number },
    sections: Four,
    shape: Four,
    color: Color,
  ): void {
    if (this.count === this.room) this.grow(this.room * 2);
    const [place, turns, section, shapes, colors] = this.columns;
    if (!place || !turns || !section || !shapes || !colors) return;
    const four = 4 * this.count;
    set(place.values, four, at.x, at.y, at.z, length);
    set(turns.values, four, turn.x, turn.y, turn.z, turn.w);
    set(section.values, four, ...sections);
    set(shapes.values, four, ...shape);
    colors.values[3 * this.count] = color.r;
    colors.values[3 * this.count + 1] = color.g;
    colors.values[3 * this.count + 2] = color.b;
    this.count += 1;
  }

  private grow(room: number): void {
    this.columns = COLUMNS.map(([name, size], place) => {
      const values = new Float32Array(room * size);
      const before = this.columns[place]?.values;
      if (before) values.set(before);
      const attribute = new InstancedBufferAttribute(values, size).setUsage(DynamicDrawUsage);
      this.geometry.setAttribute(name, attribute);
      return { values, attribute };
    });
    this.room = room;
  }
}

type Four = [number, number, number, number];

interface Column {
  values: Float32Array;
  attribute: InstancedBufferAttribute;
}

const COLUMNS: [string, number][] = [
  ['limbPlace', 4],
  ['limbTurn', 4],
  ['limbSections', 4],
  ['limbShape', 4],
  ['color', 3],
];

const UPRIGHT = { x: 0, y: 0, z: 0, w: 1 };

function set(values: Float32Array, from: number, a: number, b: number, c: number, d: number): void {
  values[from] = a;
  values[from + 1] = b;
  values[from + 2] = c;
  values[from + 3] = d;
}
