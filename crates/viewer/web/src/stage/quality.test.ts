import { expect, test } from 'vitest';
import { AdaptiveQuality, QUALITY } from './quality';

const frames = (quality: AdaptiveQuality, count: number, milliseconds: number): void => {
  for (let frame = 0; frame < count; frame += 1) quality.frame(milliseconds);
};

test('slow frames lower the quality down to the least', () => {
  const quality = new AdaptiveQuality();
  frames(quality, 24, 40);
  expect(quality.step).toBe(1);
  frames(quality, 1000, 40);
  expect(quality.step).toBe(QUALITY.length - 1);
});

test('quick frames raise it again after a while', () => {
  const quality = new AdaptiveQuality(3);
  frames(quality, 24 * 4, 16);
  expect(quality.step).toBe(2);
});

test('a step that was too much is tried again ever more rarely', () => {
  const quality = new AdaptiveQuality(2);
  frames(quality, 24, 40);
  frames(quality, 24 * 15, 16);
  expect(quality.step).toBe(3);
  frames(quality, 24, 16);
  expect(quality.step).toBe(2);
  frames(quality, 24, 40);
  frames(quality, 24 * 63, 16);
  expect(quality.step).toBe(3);
});

test('a tab that slept is not slow', () => {
  const quality = new AdaptiveQuality();
  frames(quality, 100, 5000);
  expect(quality.step).toBe(0);
});
