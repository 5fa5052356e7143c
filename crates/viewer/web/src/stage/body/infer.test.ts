import { Quaternion, Vector3 } from 'three';
import { expect, test } from 'vitest';
import { nominalSegments, tPose } from '../testing/nominal';
import { Inference } from './infer';
import { describedNullPose } from './null_pose';

const segments = nominalSegments();
const pose = describedNullPose(segments);

test('positions of the T-pose give the identity', () => {
  const { position } = tPose(segments);
  for (const turn of inferred(position)) expect(turn.angleTo(new Quaternion())).toBeLessThan(1e-3);
});

test('a body that turned as a whole is turned so', () => {
  const turn = new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), 2.1);
  const { position } = tPose(segments);
  for (let place = 0; place < segments.length; place += 1) {
    new Vector3()
      .fromArray(position, 3 * place)
      .applyQuaternion(turn)
      .toArray(position, 3 * place);
  }
  for (const found of inferred(position)) expect(found.angleTo(turn)).toBeLessThan(1e-3);
});

test('a lowered arm points down', () => {
  const { position } = tPose(segments);
  position.set([0, 0.17, 1.09], 3 * 13);
  position.set([0, 0.17, 0.84], 3 * 14);
  const arm = new Vector3(0, 1, 0).applyQuaternion(inferred(position)[12] ?? new Quaternion());
  expect(arm.z).toBeCloseTo(-1, 3);
});

test('orientations that were sent are left alone, and what is not tracked gets none', () => {
  const { position } = tPose(segments);
  position.fill(NaN, 3 * 6, 3 * 7);
  const orientation = new Float32Array(4 * segments.length).fill(NaN);
  orientation.set([0, 1, 0, 0], 0);
  new Inference(segments, pose).fill(position, orientation);
  expect([...orientation.subarray(0, 4)]).toEqual([0, 1, 0, 0]);
  expect(orientation[4 * 6]).toBeNaN();
});

function inferred(position: Float32Array): Quaternion[] {
  const orientation = new Float32Array(4 * segments.length).fill(NaN);
  new Inference(segments, pose).fill(position, orientation);
  return segments.map((_, place) => {
    const [w, x, y, z] = orientation.subarray(4 * place, 4 * place + 4);
    return new Quaternion(x, y, z, w);
  });
}
