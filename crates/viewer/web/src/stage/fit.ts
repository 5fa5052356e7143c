import { MathUtils, Vector3 } from 'three';

/** Where an eye looks and how far from there it is. */
export interface Fit {
  target: Vector3;
  distance: number;
}

/** How an eye that looks from a direction sees all points as large as can be, with a little room around. */
export function fit(points: Vector3[], direction: Vector3, fov: number, aspect: number): Fit {
  const right = new Vector3(0, 0, 1).cross(direction).normalize();
  const up = direction.clone().cross(right);
  const tall = Math.tan(MathUtils.degToRad(fov / 2)) * ROOM;
  const across = span(points, direction, right, tall * aspect);
  const over = span(points, direction, up, tall);
  const depth = Math.max(...points.map((point) => point.dot(direction)));
  const away = Math.max(across.distance, over.distance, depth + NEAREST);
  const middle = mean(points.map((point) => point.dot(direction)));
  const target = new Vector3()
    .addScaledVector(right, across.middle)
    .addScaledVector(up, over.middle)
    .addScaledVector(direction, middle);
  return { target, distance: away - middle };
}

/** The direction from which points fit closest; the first as long as no other brings them a quarter closer. */
export function bestDirection(points: Vector3[], directions: Vector3[], fov: number, aspect: number): Vector3 {
  const distances = directions.map((direction) => fit(points, direction, fov, aspect).distance);
  const nearest = Math.min(...distances);
  return directions.find((_, place) => (distances[place] ?? Infinity) < nearest * 1.25) ?? new Vector3(1, 0, 0);
}

/** The share of the picture that is filled. */
const ROOM = 0.8;
/** The least distance from the nearest point. */
const NEAREST = 1.2;

/**
 * Along one axis of the picture: the place of the eye that is nearest, and how far along the direction it is then.
 *
 * A point at `s` across and `d` along is seen by an eye at `m` across when `distance >= d + |s - m| / slope`: the best
 * is where the lines of both sides meet.
 */
function span(points: Vector3[], direction: Vector3, axis: Vector3, slope: number): { middle: number; distance: number } {
  const high = Math.max(...points.map((point) => point.dot(direction) + point.dot(axis) / slope));
  const low = Math.max(...points.map((point) => point.dot(direction) - point.dot(axis) / slope));
  return { middle: ((high - low) / 2) * slope, distance: (high + low) / 2 };
}

function mean(values: number[]): number {
  return values.reduce((sum, value) => sum + value, 0) / Math.max(values.length, 1);
}
