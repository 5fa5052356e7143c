import { Ray, Vector3 } from 'three';
import { expect, test } from 'vitest';
import { pick, pickPoints } from './pick';

const ray = new Ray(new Vector3(5, 0, 1), new Vector3(-1, 0, 0));

test('the nearest body on the ray is picked', () => {
  const bodies = [
    { id: 3, points: new Float32Array([-2, 0, 1]) },
    { id: 7, points: new Float32Array([1, 0.1, 1]) },
  ];
  expect(pick(ray, bodies)).toBe(7);
});

test('what is beside the ray, behind the eye or not tracked is not picked', () => {
  const bodies = [
    { id: 1, points: new Float32Array([0, 0.5, 1]) },
    { id: 2, points: new Float32Array([9, 0, 1]) },
    { id: 3, points: new Float32Array([NaN, NaN, NaN]) },
  ];
  expect(pick(ray, bodies)).toBeNull();
});

test('the middle of a bone can be picked too', () => {
  const points = pickPoints(new Float32Array([0, 0, 0.5, 0, 0, 1.5]), [null, 0]);
  expect(pick(ray, [{ id: 4, points }])).toBe(4);
});
