import { expect, test } from 'vitest';
import { nominalSegments, tPose } from '../testing/nominal';
import { inPlace } from './in_place';
import { describedNullPose } from './null_pose';

const segments = nominalSegments();
const pose = describedNullPose(segments);

test('orientations alone give the body of the null pose, where no position came', () => {
  const { position, orientation } = tPose(segments);
  const nothing = new Float32Array(position.length).fill(NaN);
  const placed = inPlace(segments, pose, nothing, orientation, 0);
  placed.forEach((value, at) => expect(value).toBeCloseTo(position[at] ?? NaN, 5));
});

test('several subjects stand beside each other', () => {
  const { position, orientation } = tPose(segments);
  const placed = inPlace(segments, pose, position, orientation, 1.2);
  expect(placed[1]).toBeCloseTo(1.2, 5);
  expect(placed[2]).toBeCloseTo(0.93, 5);
});

test('what hangs on an orientation that is not known has no place', () => {
  const { position, orientation } = tPose(segments);
  orientation.fill(NaN, 4 * 12, 4 * 13);
  const nothing = new Float32Array(position.length).fill(NaN);
  const placed = inPlace(segments, pose, nothing, orientation, 0);
  expect([placed[3 * 12], placed[3 * 13], placed[3 * 14]]).toEqual([NaN, NaN, NaN]);
});
