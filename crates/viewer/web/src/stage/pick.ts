import { type Ray, Vector3 } from 'three';

/** Something that can be clicked: points of its body, x, y, z each, NaN for none. */
export interface Pickable {
  id: number;
  points: Float32Array;
}

/** Whose body a ray meets first: the nearest with a point within `reach` metres of the ray. */
export function pick(ray: Ray, bodies: Pickable[], reach = 0.17): number | null {
  let found: number | null = null;
  let nearest = Infinity;
  const at = new Vector3();
  for (const { id, points } of bodies) {
    for (let place = 0; place + 2 < points.length; place += 3) {
      at.fromArray(points, place);
      const along = at.clone().sub(ray.origin).dot(ray.direction);
      if (along > 0 && along < nearest && ray.distanceSqToPoint(at) < reach * reach) [found, nearest] = [id, along];
    }
  }
  return found;
}

/** The segments' origins and the middles of the ways to their parents. */
export function pickPoints(position: Float32Array, parents: (number | null)[]): Float32Array {
  const points = new Float32Array(2 * position.length);
  points.set(position);
  parents.forEach((parent, place) => {
    for (let axis = 0; axis < 3; axis += 1) {
      const here = position[3 * place + axis] ?? NaN;
      points[position.length + 3 * place + axis] =
        (here + (parent === null ? here : (position[3 * parent + axis] ?? NaN))) / 2;
    }
  });
  return points;
}
