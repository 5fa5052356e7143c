import { Quaternion, Vector3 } from 'three';
import type { Segment } from '../../protocol/types';
import { type NullPose, offset } from './null_pose';

/**
 * Positions for a subject that streams orientations alone: those that came, moved aside by `aside` metres along Y so
 * that several such subjects do not stand in each other; where none came, what the orientations and the null pose give.
 */
export function inPlace(
  segments: Segment[],
  nullPose: NullPose,
  position: Float32Array,
  orientation: Float32Array,
  aside: number,
): Float32Array {
  const placed = new Float32Array(3 * segments.length).fill(NaN);
  placed.set(position.subarray(0, placed.length));
  for (let at = 1; at < placed.length; at += 3) placed[at] = (placed[at] ?? NaN) + aside;
  segments.forEach(({ parent }, place) => {
    if (Number.isFinite(placed[3 * place])) return;
    const found =
      parent === null
        ? root(nullPose[place] ?? null, aside)
        : hung(segments, nullPose, placed, orientation, place, parent);
    found?.toArray(placed, 3 * place);
  });
  return placed;
}

function root(origin: Vector3 | null, aside: number): Vector3 | null {
  return origin ? new Vector3(0, aside, origin.z) : null;
}

function hung(
  segments: Segment[],
  nullPose: NullPose,
  placed: Float32Array,
  orientation: Float32Array,
  place: number,
  parent: number,
): Vector3 | null {
  const way = offset(segments, nullPose, place);
  const [w, x, y, z] = orientation.subarray(4 * parent, 4 * parent + 4);
  const at = way?.applyQuaternion(new Quaternion(x, y, z, w)).add(new Vector3().fromArray(placed, 3 * parent));
  return at && Number.isFinite(at.x + at.y + at.z) && Number.isFinite(orientation[4 * place]) ? at : null;
}
