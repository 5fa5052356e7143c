import { describe, expect, it } from 'vitest';
import { Playhead } from './playhead';
import { frameAt, frameTime, gapSpans, nearestFrame, wholeSpan } from './timeline';
import { roundStep } from './track';
import type { Take } from '../protocol/types';

/** Ten frames at 100 Hz from 2 s; five samples are missing behind frame 3, one behind frame 6. */
const take = {
  start_s: 2,
  rate_hz: 100,
  frames: 10,
  gaps: [
    [3, 5],
    [6, 1],
  ],
} as unknown as Take;

describe('the timeline', () => {
  it('knows when each frame is, gaps included', () => {
    expect([0, 3, 4, 6, 7, 9].map((frame) => Math.round((frameTime(take, frame) - 2) * 100))).toEqual([
      0, 3, 9, 11, 13, 15,
    ]);
  });

  it('finds each frame again at its own time', () => {
    for (let frame = 0; frame < 10; frame++) {
      expect(frameAt(take, frameTime(take, frame))).toBe(frame);
      expect(nearestFrame(take, frameTime(take, frame) + 0.001)).toBe(frame);
    }
  });

  it('shows the frame before a gap until the gap ends, and none outside', () => {
    expect(frameAt(take, 2.085)).toBe(3);
    expect(frameAt(take, 1.99)).toBe(-1);
    expect(frameAt(take, 2.17)).toBe(-1);
    expect(nearestFrame(take, 99)).toBe(9);
    expect(nearestFrame(take, 0)).toBe(0);
  });

  it('spans all takes', () => {
    const other = { start_s: 0.5, rate_hz: 50, frames: 11, gaps: [] } as unknown as Take;
    expect(wholeSpan([take, other])).toEqual({ from: 0.5, to: frameTime(take, 9) });
    expect(gapSpans(take).map(({ from, to }) => [from, to].map((time) => time.toFixed(2)))).toEqual([
      ['2.04', '2.09'],
      ['2.12', '2.13'],
    ]);
  });
});

describe('the playhead', () => {
  it('stops at the end, and begins again from there', () => {
    const playhead = new Playhead({ from: 0, to: 2 });
    playhead.toggle();
    playhead.speed = 4;
    expect(playhead.advance(0.25)).toBe(true);
    expect(playhead.position).toBe(1);
    playhead.advance(1);
    expect([playhead.position, playhead.playing]).toEqual([2, false]);
    playhead.toggle();
    expect([playhead.position, playhead.playing]).toEqual([0, true]);
  });

  it('repeats a range without losing time at its end', () => {
    const playhead = new Playhead({ from: 0, to: 10 });
    playhead.seek(4);
    playhead.mark('from');
    playhead.seek(6);
    playhead.mark('to');
    expect([playhead.range, playhead.repeat]).toEqual([{ from: 4, to: 6 }, true]);
    playhead.seek(5.5);
    playhead.toggle();
    playhead.advance(1);
    expect(playhead.position).toBeCloseTo(4.5);
    playhead.seek(1);
    playhead.advance(0.1);
    expect(playhead.position).toBe(4);
  });

  it('never has an empty range', () => {
    const playhead = new Playhead({ from: 0, to: 10 });
    playhead.mark('to');
    expect(playhead.range).toBeNull();
    playhead.seek(10);
    playhead.mark('from');
    expect(playhead.range).toBeNull();
    playhead.seek(9);
    playhead.mark('from');
    expect(playhead.range).toEqual({ from: 9, to: 10 });
  });
});

it('times stand at round distances', () => {
  expect([1.85, 10, 600, 40_000].map((length) => roundStep(length, 10))).toEqual([0.2, 1, 60, 7200]);
});
