import { Matrix4, Quaternion, Vector3 } from 'three';

/** What a part is made of, in the eye's terms. */
export type Tone = 'suit' | 'trousers' | 'shoe' | 'skin' | 'visor' | 'object';

/** Radii of an elliptical section in metres: across the broad axis and across the deep one. */
export type Section = [broad: number, deep: number];

/**
 * A rounded, tapered piece of a body, fixed to one segment.
 *
 * Its own axes are x along it, y across its broad side, z = x * y across its deep one.
 */
export interface Part {
  /** The place of the segment that it moves with. */
  segment: number;
  /** Where it starts, in the segment's axes. */
  at: Vector3;
  /** From the part's axes to the segment's. */
  turn: Quaternion;
  length: number;
  start: Section;
  end: Section;
  /** How far the rounded ends reach past start and end. */
  caps: [number, number];
  /** What the radii gain in the middle. */
  bulge: number;
  /** How far the middle is pushed along z. */
  bow: number;
  tone: Tone;
  /** Small parts, of which there are many: drawn with few triangles. */
  fine: boolean;
}

/** What can be said of a part besides where it goes. */
export interface Shape {
  start: Section;
  end?: Section;
  caps?: [number, number];
  bulge?: number;
  bow?: number;
  /** The direction of the broad side in the segment's axes. */
  broad?: Vector3;
  tone?: Tone;
  fine?: boolean;
}

/** A part between two points of a segment. */
export function part(segment: number, from: Vector3, to: Vector3, shape: Shape): Part {
  const along = to.clone().sub(from);
  const end = shape.end ?? shape.start;
  return {
    segment,
    at: from.clone(),
    turn: turnTo(along, shape.broad ?? LEFT),
    length: along.length(),
    start: shape.start,
    end,
    caps: shape.caps ?? [mean(shape.start), mean(end)],
    bulge: shape.bulge ?? 0,
    bow: shape.bow ?? 0,
    tone: shape.tone ?? 'suit',
    fine: shape.fine ?? false,
  };
}

/** The rotation that takes x along one direction and y as near as can be to another. */
export function turnTo(along: Vector3, broad: Vector3): Quaternion {
  const x = along.lengthSq() > 1e-12 ? along.clone().normalize() : new Vector3(0, 0, 1);
  let z = x.clone().cross(broad);
  if (z.lengthSq() < 1e-6) z = x.clone().cross(Math.abs(x.x) < 0.9 ? FORWARD : LEFT);
  z.normalize();
  const y = z.clone().cross(x);
  return new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(x, y, z));
}

const FORWARD = new Vector3(1, 0, 0);
const LEFT = new Vector3(0, 1, 0);

function mean([broad, deep]: Section): number {
  return (broad + deep) / 2;
}
