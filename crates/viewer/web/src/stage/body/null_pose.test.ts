import { Quaternion, Vector3 } from 'three';
import { expect, test } from 'vitest';
import { nominalSegments, tPose } from '../testing/nominal';
import { describedNullPose, observedNullPose, offset } from './null_pose';

const segments = nominalSegments();

test('where the description is silent, the name tells the nominal place', () => {
  const silent = segments.map((segment) => ({ ...segment, origin: null }));
  expect(describedNullPose(silent)).toEqual(describedNullPose(segments));
});

test('a sample of the described size shows nothing new, wherever it stands', () => {
  const { position, orientation } = tPose(segments, [3, -2, 0.1]);
  expect(observedNullPose(segments, describedNullPose(segments), position, orientation)).toBeNull();
});

test('a sample tells the lengths of a skeleton that was described by its names alone', () => {
  const turn = new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), 1.2);
  const { position, orientation } = tPose(segments);
  for (let place = 0; place < segments.length; place += 1) {
    new Vector3()
      .fromArray(position, 3 * place)
      .multiplyScalar(1.1)
      .applyQuaternion(turn)
      .toArray(position, 3 * place);
    orientation.set([turn.w, turn.x, turn.y, turn.z], 4 * place);
  }
  const observed = observedNullPose(segments, describedNullPose(segments), position, orientation);
  const shin = observed && offset(segments, observed, 17);
  expect(shin?.z).toBeCloseTo(-0.41 * 1.1, 5);
  expect(shin?.x).toBeCloseTo(0, 5);
});

test('without orientations only lengths are learnt', () => {
  const { position, orientation } = tPose(segments);
  orientation.fill(NaN);
  position.set([0.3, -0.17, 1.38], 3 * 9);
  const observed = observedNullPose(segments, describedNullPose(segments), position, orientation);
  expect(
    observed &&
      offset(segments, observed, 9)
        ?.toArray()
        .map((value) => Math.round(value * 1e5) / 1e5),
  ).toEqual([0, -0.3, 0]);
});

test('segments that are not tracked keep what was known of them', () => {
  const { position, orientation } = tPose(segments, [0, 0, 0]);
  position.fill(NaN, 3 * 8, 3 * 11);
  expect(observedNullPose(segments, describedNullPose(segments), position, orientation)).toBeNull();
});
