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
  const half = Math.tan(MathUtils.degToRad(fov / 2));
  const depths = points.map((point) => point.dot(direction));
  const [across, over] = [right, up].map((axis) => points.map((point) => point.dot(axis))) as [number[], number[]];
  const away = Math.max(
    nearest(across, depths, half * aspect * WIDE),
    nearest(over, depths, half * TALL),
    Math.max(...depths) + NEAREST,
  );
  const middle = mean(depths);
  const target = new Vector3()
    .addScaledVector(right, balanced(across, depths, away))
    .addScaledVector(up, balanced(over, depths, away))
    .addScaledVector(direction, middle);
  return { target, distance: away - middle };
}

/** The direction from which points fit closest; the first as long as no other brings them a quarter closer. */
export function bestDirection(points: Vector3[], directions: Vector3[], fov: number, aspect: number): Vector3 {
  const distances = directions.map((direction) => fit(points, direction, fov, aspect).distance);
  const nearest = Math.min(...distances);
  return directions.find((_, place) => (distances[place] ?? Infinity) < nearest * 1.25) ?? new Vector3(1, 0, 0);
}

/** The shares of the picture that are filled. */
const WIDE = 0.86;
const TALL = 0.94;
/** The least distance from the nearest point. */
const NEAREST = 1.2;

/**
 * How far along the direction an eye must at least be to see points that are `places` across and `depths` along.
 *
 * An eye at `m` across sees one when its distance is `d + |s - m| / slope` or more: the best is where the lines of both
 * sides meet.
 */
function nearest(places: number[], depths: number[], slope: number): number {
  const side = (sign: number) => Math.max(...places.map((place, at) => (depths[at] ?? 0) + (sign * place) / slope));
  return (side(1) + side(-1)) / 2;
}

/** Where across an eye so far away must be that both edges of its picture have the same room left. */
function balanced(places: number[], depths: number[], away: number): number {
  const beyond = (middle: number, sign: number) =>
    Math.max(...places.map((place, at) => (sign * (place - middle)) / (away - (depths[at] ?? 0))));
  let [low, high] = [Math.min(...places), Math.max(...places)];
  for (let step = 0; step < 24; step += 1) {
    const middle = (low + high) / 2;
    if (beyond(middle, 1) > beyond(middle, -1)) low = middle;
    else high = middle;
  }
  return (low + high) / 2;
}

function mean(values: number[]): number {
  return values.reduce((sum, value) => sum + value, 0) / Math.max(values.length, 1);
}
