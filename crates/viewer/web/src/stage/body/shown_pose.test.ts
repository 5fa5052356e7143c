import { expect, test } from 'vitest';
import { nominalSegments, tPose } from '../testing/nominal';
import { describedNullPose } from './null_pose';
import { Seen, ShownPose } from './shown_pose';

const segments = nominalSegments();

test('what is streamed is what is shown', () => {
  const pose = new ShownPose(segments, describedNullPose(segments));
  const record = tPose(segments, [1.5, -2, 0.25]);
  pose.take(record);
  expect(pose.position).toEqual(record.position);
  expect(pose.orientation).toEqual(record.orientation);
  expect(pose.count(Seen.Now)).toBe(segments.length);
});

test('a segment that is no longer tracked stays where it was last', () => {
  const pose = new ShownPose(segments, describedNullPose(segments));
  pose.take(tPose(segments, [1, 0, 0]));
  const later = tPose(segments, [2, 0, 0]);
  later.position.fill(NaN, 3 * 10, 3 * 11);
  pose.take(later);
  expect(pose.seen[10]).toBe(Seen.Before);
  expect(pose.position[3 * 10]).toBe(1);
  expect(pose.position[3 * 9]).toBe(2);
});

test('a segment that was never tracked has no place, least of all the origin', () => {
  const pose = new ShownPose(segments, describedNullPose(segments));
  const record = tPose(segments);
  record.position.fill(NaN, 3 * 10, 3 * 11);
  pose.take(record);
  expect(pose.seen[10]).toBe(Seen.Never);
  expect([...pose.position.subarray(30, 33)]).toEqual([NaN, NaN, NaN]);
});

test('a sample with fewer segments than are described is taken as far as it goes', () => {
  const pose = new ShownPose(segments, describedNullPose(segments));
  pose.take(tPose(segments.slice(0, 5)));
  expect(pose.count(Seen.Now)).toBe(5);
});

test('positions alone are known to be without orientations', () => {
  const pose = new ShownPose(segments, describedNullPose(segments));
  const record = tPose(segments);
  record.orientation.fill(NaN);
  pose.take(record);
  expect(pose.turned).toBe(false);
  expect(pose.orientation[0]).toBeCloseTo(1, 5);
});
