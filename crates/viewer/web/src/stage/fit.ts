import { type Box3, MathUtils, Vector3 } from 'three';

/** How far from a box's centre, in a direction, an eye must be to see all of it with a little room around. */
export function fitDistance(box: Box3, direction: Vector3, fov: number, aspect: number): number {
  const right = new Vector3(0, 0, 1).cross(direction).normalize();
  const up = direction.clone().cross(right);
  const tall = Math.tan(MathUtils.degToRad(fov / 2)) * ROOM;
  const wide = tall * aspect;
  const centre = box.getCenter(new Vector3());
  const needed = corners(box).map((corner) => {
    const way = corner.sub(centre);
    return way.dot(direction) + Math.max(Math.abs(way.dot(right)) / wide, Math.abs(way.dot(up)) / tall);
  });
  return Math.max(...needed, 1.5);
}

/** The share of the picture that is filled. */
const ROOM = 0.8;

function corners({ min, max }: Box3): Vector3[] {
  return [min.x, max.x].flatMap((x) => [min.y, max.y].flatMap((y) => [min.z, max.z].map((z) => new Vector3(x, y, z))));
}
