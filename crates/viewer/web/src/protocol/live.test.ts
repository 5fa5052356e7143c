import { expect, it } from 'vitest';
import { backoff } from './live';

it('waits longer after each failure, four seconds at most, and not all pages at once', () => {
  expect([0, 1, 2, 3, 4, 9].map((failures) => backoff(failures, 0.5))).toEqual([0.25, 0.5, 1, 2, 4, 4]);
  expect([backoff(9, 0), backoff(9, 1)]).toEqual([3, 5]);
});
