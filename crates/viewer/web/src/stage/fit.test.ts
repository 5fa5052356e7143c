import { PerspectiveCamera, Vector3 } from 'three';
import { expect, test } from 'vitest';
import { bestDirection, fit } from './fit';

const points = [new Vector3(-3, 1, 0), new Vector3(5, 2, 1.8), new Vector3(0, -6, 0.9)];

test.each([1.6, 0.46])('all points are seen at an aspect of %f', (aspect) => {
  const direction = new Vector3(0.7, -0.6, 0.4).normalize();
  const { target, distance } = fit(points, direction, 36, aspect);
  const camera = new PerspectiveCamera(36, aspect);
  camera.up.set(0, 0, 1);
  camera.position.copy(target).addScaledVector(direction, distance);
  camera.lookAt(target);
  camera.updateMatrixWorld();
  const seen = points.map((point) => point.clone().project(camera));
  const widest = Math.max(...seen.map(({ x }) => Math.abs(x)));
  const tallest = Math.max(...seen.map(({ y }) => Math.abs(y)));
  expect(widest).toBeLessThan(0.87);
  expect(tallest).toBeLessThan(0.95);
  expect(Math.max(widest / 0.86, tallest / 0.94)).toBeGreaterThan(0.97);
  for (const values of [seen.map(({ x }) => x), seen.map(({ y }) => y)]) {
    expect(Math.min(...values) + Math.max(...values)).toBeCloseTo(0, 3);
  }
});

test('a row is looked at from where it is close, unless the first direction is about as good', () => {
  const row = Array.from({ length: 9 }, (_, place) => new Vector3(0, place * 3, 1));
  const along = new Vector3(0, -1, 0.2).normalize();
  const across = new Vector3(1, 0, 0.2).normalize();
  expect(bestDirection(row, [across, across.clone().applyAxisAngle(new Vector3(0, 0, 1), 0.1)], 36, 1.6)).toBe(across);
  expect(bestDirection(row, [across, along], 36, 0.3)).toBe(along);
});
