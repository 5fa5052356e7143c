import { expect, test } from 'vitest';
import { looksSame } from './same';
import { nominalSegments, tPose } from './testing/nominal';

const segments = nominalSegments();

test('a sample that is only older looks the same, with all that is not tracked', () => {
  expect(looksSame(tPose(segments), { ...tPose(segments), age: 3 })).toBe(true);
});

test('a sample that moved, came later or has another state does not', () => {
  const record = tPose(segments);
  expect(looksSame(record, tPose(segments, [0.001, 0, 0]))).toBe(false);
  expect(looksSame(record, { ...record, time: 0.1 })).toBe(false);
  expect(looksSame(record, { ...record, state: 2 })).toBe(false);
  const position = record.position.slice().fill(NaN, 0, 3);
  expect(looksSame(record, { ...record, position })).toBe(false);
});
