import { Color } from 'three';
import { expect, test } from 'vitest';
import type { Lines } from './batch/lines';
import { Trail } from './trail';

test('a trail is as long as its seconds', () => {
  const trail = new Trail();
  for (let step = 0; step < 600; step += 1) trail.add(step / 60, 0, 0, step / 60);
  const drawn = lines(trail);
  expect(drawn[0]?.[0]).toBeGreaterThan(7.3);
  expect(drawn.at(-1)?.[0]).toBeGreaterThan(9.9);
});

test.each([
  ['back', 1],
  ['far ahead', 60],
])('a seek %s begins another trail', (_, time) => {
  const trail = new Trail();
  for (let step = 0; step < 60; step += 1) trail.add(0, 0, 0, 5 + step / 30);
  trail.add(3, 0, 0, time);
  expect(lines(trail)).toEqual([[3, 0, 0]]);
});

/** Where each line of a trail begins. */
function lines(trail: Trail): number[][] {
  const from: number[][] = [];
  const record = { add: (a: ArrayLike<number>) => from.push(Array.from(a)) } as unknown as Lines;
  trail.draw(record, new Color(), [0, 0, 0]);
  return from;
}
