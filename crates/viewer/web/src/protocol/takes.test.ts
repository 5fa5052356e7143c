import { expect, it, vi } from 'vitest';
import { TakeFrames } from './takes';
import type { Take } from './types';

const take = { id: 3, frames: 10_000 } as Take;

/** As many empty records as are asked for, numbered by their frame. */
function answer(path: string): Promise<ArrayBuffer> {
  const [, from, count] = /from=(\d+)&count=(\d+)/.exec(path)!.map(Number);
  const view = new DataView(new ArrayBuffer(52 * count!));
  for (let place = 0; place < count!; place++) {
    view.setUint32(52 * place, 52, true);
    view.setUint32(52 * place + 8, from! + place, true);
  }
  return Promise.resolve(view.buffer as ArrayBuffer);
}

it('gives the frame that was asked for once it has come, and fetches what follows', async () => {
  const fetched = vi.fn(answer);
  const arrived = vi.fn();
  const frames = new TakeFrames(take, arrived, fetched);
  expect(frames.frame(481)).toBeUndefined();
  await vi.waitFor(() => expect(arrived).toHaveBeenCalledTimes(2));
  expect(frames.frame(481)?.sample).toBe(481);
  expect(fetched.mock.calls.map(([path]) => path)).toEqual([
    '/api/takes/3/frames?from=480&count=240',
    '/api/takes/3/frames?from=720&count=240',
  ]);
  expect(frames.frame(10_000)).toBeUndefined();
});

it('asks for no more than there is, and keeps a bounded number of blocks', async () => {
  const fetched = vi.fn(answer);
  const frames = new TakeFrames(take, () => undefined, fetched);
  for (let frame = 0; frame < take.frames; frame += 240) frames.frame(frame);
  expect(fetched.mock.calls.at(-1)).toEqual(['/api/takes/3/frames?from=9840&count=160']);
  await vi.waitFor(() => expect(frames.frame(9_999)?.sample).toBe(9_999));
  const before = fetched.mock.calls.length;
  frames.frame(0);
  expect(fetched.mock.calls.length).toBe(before + 2);
});
