import { expect, it } from 'vitest';
import { points } from './sparkline';

it('a sparkline ends at the right, and is as high as the highest rate', () => {
  const seconds = [0, 120, 240].map((rate) => ({ rate, missing: 0 }));
  expect(points(seconds)).toBe('110.9,19.5 114.9,13.8 119.0,8.0');
  expect(points([])).toBe('');
});
