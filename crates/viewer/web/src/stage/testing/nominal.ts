import type { Segment, Subject, SubjectRecord, Vector } from '../../protocol/types';

/** MVN's body with nominal sizes, for tests: name, parent, origin. */
const BODY: [string, number | null, Vector][] = [
  ['Pelvis', null, [0, 0, 0.93]],
  ['L5', 0, [0, 0, 1.03]],
  ['L3', 1, [0, 0, 1.12]],
  ['T12', 2, [0, 0, 1.21]],
  ['T8', 3, [0, 0, 1.3]],
  ['Neck', 4, [0, 0, 1.43]],
  ['Head', 5, [0, 0, 1.52]],
  ['RightShoulder', 4, [0, -0.03, 1.38]],
  ['RightUpperArm', 7, [0, -0.17, 1.38]],
  ['RightForeArm', 8, [0, -0.46, 1.38]],
  ['RightHand', 9, [0, -0.71, 1.38]],
  ['LeftShoulder', 4, [0, 0.03, 1.38]],
  ['LeftUpperArm', 11, [0, 0.17, 1.38]],
  ['LeftForeArm', 12, [0, 0.46, 1.38]],
  ['LeftHand', 13, [0, 0.71, 1.38]],
  ['RightUpperLeg', 0, [0, -0.09, 0.93]],
  ['RightLowerLeg', 15, [0, -0.09, 0.5]],
  ['RightFoot', 16, [0, -0.09, 0.09]],
  ['RightToe', 17, [0.16, -0.09, 0.02]],
  ['LeftUpperLeg', 0, [0, 0.09, 0.93]],
  ['LeftLowerLeg', 19, [0, 0.09, 0.5]],
  ['LeftFoot', 20, [0, 0.09, 0.09]],
  ['LeftToe', 21, [0.16, 0.09, 0.02]],
];

export function nominalSegments(): Segment[] {
  return BODY.map(([name, parent, origin]) => ({ name, parent, origin: [...origin], kind: 'body', points: [] }));
}

export function subjectOf(segments: Segment[]): Subject {
  const contacts = ['LeftFoot_Heel', 'LeftFoot_Toe', 'RightFoot_Heel', 'RightFoot_Toe'];
  return {
    id: 0,
    source: 0,
    name: 'Ada',
    color: null,
    rate_hz: 60,
    kind: 'person',
    segments,
    joints: [],
    contacts,
    channels: [],
  };
}

/** A sample of the T-pose, `shift` metres away from the null pose's place. */
export function tPose(segments: Segment[], shift: Vector = [0, 0, 0]): SubjectRecord {
  const position = segments.flatMap(({ origin }) =>
    (origin ?? [NaN, NaN, NaN]).map((value, axis) => value + (shift[axis] ?? 0)),
  );
  return {
    id: 0,
    sample: 0,
    contacts: 0,
    time: 0,
    age: 0,
    timecode: NaN,
    state: 0,
    flags: 3,
    position: new Float32Array(position),
    orientation: new Float32Array(segments.flatMap(() => [1, 0, 0, 0])),
    centerOfMass: new Float32Array([NaN, NaN, NaN]),
    markers: new Float32Array(),
  };
}
