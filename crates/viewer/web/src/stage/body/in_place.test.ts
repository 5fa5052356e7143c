import { expect, test } from 'vitest';
import { nominalSegments, tPose } from '../testing/nominal';
import { inPlace } from './in_place';

test('several subjects stand beside each other', () => {
  const { position } = tPose(nominalSegments());
  position.fill(NaN, 3 * 12, 3 * 13);
  const placed = inPlace(position, 1.2);
  expect(placed[1]).toBeCloseTo(1.2, 5);
  expect(placed[2]).toBeCloseTo(0.93, 5);
  expect([...placed.subarray(36, 39)]).toEqual([NaN, NaN, NaN]);
});
