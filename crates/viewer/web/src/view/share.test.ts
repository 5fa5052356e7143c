import { expect, it } from 'vitest';
import { readHash, writeHash } from './share';

it('a view is read as it was written', () => {
  const view = {
    camera: { position: [3.25, -1, 1.7] as [number, number, number], target: [0, 0.5, 1] as [number, number, number] },
    follow: 2,
    show: ['axes', 'names'],
    hidden: [1, 3],
    frame: 481,
    plots: ['0:joint_angles/jRightKnee/z', '1:position/Head & neck/z'],
  };
  expect(readHash(`#${writeHash(view)}`)).toEqual(view);
  expect(writeHash({ show: [] })).toBe('show=');
  expect(readHash('#show=')).toEqual({ show: [] });
});

it('what makes no sense is left out', () => {
  expect(readHash('#camera=1,2,x&follow=&frame=-3&hidden=a&other=1')).toEqual({});
  expect(readHash('')).toEqual({});
});

it('leaves out a camera that sees nothing', () => {
  expect(readHash('#camera=1e9,0,1,0,0,1').camera).toBeUndefined();
  expect(readHash('#camera=1,2,3,1,2,3').camera).toBeUndefined();
  expect(readHash('#camera=4,2,3,1,2,3').camera).toBeDefined();
});
