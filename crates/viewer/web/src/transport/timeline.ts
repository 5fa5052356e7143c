/**
 * When each frame of a take is, in seconds on the timeline that all takes share.
 *
 * Samples that are missing take their time: the frame before such a gap is shown until the gap ends.
 */

import type { Take } from '../protocol/types';

/** A stretch of a timeline, in seconds. */
export interface Span {
  from: number;
  to: number;
}

/** When a frame is. */
export function frameTime(take: Take, frame: number): number {
  return take.start_s + sampleOffset(take, frame) / take.rate_hz;
}

/** The frame that is shown at a time: the last one that has come by then; -1 before the first, and after the last. */
export function frameAt(take: Take, seconds: number): number {
  // Half a thousandth of a sample: a time that was computed from a frame must give this frame again.
  const offset = Math.floor((seconds - take.start_s) * take.rate_hz + 0.0005);
  if (offset < 0) return -1;
  const frame = frameOfOffset(take, offset);
  return frame < take.frames ? frame : -1;
}

/** The frame nearest to a time, also outside of the take. */
export function nearestFrame(take: Take, seconds: number): number {
  const offset = Math.round((seconds - take.start_s) * take.rate_hz);
  return Math.min(Math.max(frameOfOffset(take, offset), 0), Math.max(take.frames - 1, 0));
}

/** From the beginning of the first take to the last frame of all. */
export function wholeSpan(takes: Take[]): Span {
  const from = Math.min(...takes.map((take) => take.start_s));
  const to = Math.max(...takes.map((take) => frameTime(take, Math.max(take.frames - 1, 0))));
  return takes.length > 0 ? { from, to } : { from: 0, to: 0 };
}

/** The gaps of a take, as stretches without a frame. */
export function gapSpans(take: Take): Span[] {
  return take.gaps.map(([before, missing]) => {
    const from = frameTime(take, before) + 1 / take.rate_hz;
    return { from, to: from + missing / take.rate_hz };
  });
}

/** Samples from the first to that of a frame. */
function sampleOffset(take: Take, frame: number): number {
  let offset = frame;
  for (const [before, missing] of take.gaps) {
    if (before >= frame) break;
    offset += missing;
  }
  return offset;
}

/** The last frame whose sample is at most so many after the first. */
function frameOfOffset(take: Take, offset: number): number {
  let skipped = 0;
  for (const [before, missing] of take.gaps) {
    const begins = before + skipped;
    if (offset <= begins) break;
    if (offset <= begins + missing) return before;
    skipped += missing;
  }
  return offset - skipped;
}
