import { Quaternion, Vector3 } from 'three';
import type { Segment } from '../../protocol/types';

/**
 * Where each segment's origin is when every orientation is the identity: metres, Z up. `null` where nothing says.
 *
 * Only the ways from parents to children count; where the whole stands does not.
 */
export type NullPose = (Vector3 | null)[];

/** What the description says; where it is silent, what MVN's nominal adult has by the segment's name. */
export function describedNullPose(segments: Segment[]): NullPose {
  if (segments.some((segment) => segment.origin)) {
    return segments.map((segment) => (segment.origin ? new Vector3(...segment.origin) : null));
  }
  return segments.map((segment) => {
    const nominal = NOMINAL[segment.name];
    return nominal ? new Vector3(...nominal) : null;
  });
}

/** The way from a segment's parent to it, in the parent's axes. */
export function offset(segments: Segment[], pose: NullPose, place: number): Vector3 | null {
  const parent = segments[place]?.parent;
  const origin = pose[place];
  const from = parent == null ? null : pose[parent];
  return origin && from ? origin.clone().sub(from) : null;
}

/**
 * The null pose that a sample shows, where it differs from what is known by more than `tolerance` metres; else null.
 *
 * `position` and `orientation` are as in a `SubjectRecord`. Without orientations only the lengths are taken.
 */
export function observedNullPose(
  segments: Segment[],
  known: NullPose,
  position: Float32Array,
  orientation: Float32Array,
  tolerance = 0.015,
): NullPose | null {
  const observed: NullPose = [];
  let differs = false;
  segments.forEach((segment, place) => {
    const described = offset(segments, known, place);
    const seen = seenOffset(segment.parent, place, described, position, orientation);
    const way = seen ?? described;
    const from = segment.parent == null ? new Vector3() : observed[segment.parent];
    observed.push(
      way && from ? from.clone().add(way) : (known[place]?.clone() ?? (segment.parent == null ? new Vector3() : null)),
    );
    if (seen && (!described || seen.distanceTo(described) > tolerance)) differs = true;
  });
  return differs ? observed : null;
}

function seenOffset(
  parent: number | null,
  place: number,
  described: Vector3 | null,
  position: Float32Array,
  orientation: Float32Array,
): Vector3 | null {
  if (parent == null) return null;
  const way = new Vector3().fromArray(position, 3 * place).sub(new Vector3().fromArray(position, 3 * parent));
  if (!Number.isFinite(way.x + way.y + way.z)) return null;
  const [w, x, y, z] = orientation.subarray(4 * parent, 4 * parent + 4);
  const turn = new Quaternion(x, y, z, w);
  if (Number.isFinite(turn.lengthSq()) && turn.lengthSq() > 0.5) return way.applyQuaternion(turn.normalize().invert());
  // Without an orientation the direction is the description's; a segment of no length has none.
  return described && described.lengthSq() > 1e-8 ? described.clone().setLength(way.length()) : null;
}

/** MV0305 3.1 table 1: an adult of 1.75 m. */
const NOMINAL: Record<string, [number, number, number]> = {
  Pelvis: [0, 0, 0.93],
  L5: [0, 0, 1.03],
  L3: [0, 0, 1.12],
  T12: [0, 0, 1.21],
  T8: [0, 0, 1.3],
  Neck: [0, 0, 1.43],
  Head: [0, 0, 1.52],
  RightShoulder: [0, -0.03, 1.38],
  RightUpperArm: [0, -0.17, 1.38],
  RightForeArm: [0, -0.46, 1.38],
  RightHand: [0, -0.71, 1.38],
  LeftShoulder: [0, 0.03, 1.38],
  LeftUpperArm: [0, 0.17, 1.38],
  LeftForeArm: [0, 0.46, 1.38],
  LeftHand: [0, 0.71, 1.38],
  RightUpperLeg: [0, -0.09, 0.93],
  RightLowerLeg: [0, -0.09, 0.5],
  RightFoot: [0, -0.09, 0.09],
  RightToe: [0.16, -0.09, 0.02],
  LeftUpperLeg: [0, 0.09, 0.93],
  LeftLowerLeg: [0, 0.09, 0.5],
  LeftFoot: [0, 0.09, 0.09],
  LeftToe: [0.16, 0.09, 0.02],
};
