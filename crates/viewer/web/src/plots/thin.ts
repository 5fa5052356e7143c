/** A long channel as a chart can show it: an hour at 240 Hz has 900 samples for each pixel. */

import type { Column } from './table';

/**
 * The samples between two times, and one on each side. Where there are more than four for each of so many buckets, each
 * bucket is its lowest and its highest value instead, so that no peak is lost. Channels with the same times stay so.
 */
export function thin({ time, value }: Column, min: number, max: number, buckets: number): Column {
  const from = Math.max(firstAfter(time, min) - 1, 0);
  const to = Math.min(firstAfter(time, max) + 1, time.length);
  const each = Math.ceil((to - from) / buckets);
  if (each <= 4) return { time: time.subarray(from, to), value: value.subarray(from, to) };
  // By the samples' own numbers, so that what is drawn does not flicker while the view moves.
  const first = Math.floor(from / each);
  const count = Math.ceil(to / each) - first;
  const thinned = { time: new Float64Array(2 * count), value: new Float32Array(2 * count) };
  for (let bucket = 0; bucket < count; bucket++) {
    const begin = (first + bucket) * each;
    const end = Math.min(begin + each, time.length);
    const [one, other] = extremes(value, begin, end);
    thinned.time.set([time[begin]!, time[(begin + end) >> 1]!], 2 * bucket);
    thinned.value.set([one, other], 2 * bucket);
  }
  return thinned;
}

/** The lowest and the highest of some values, in the order in which they come; NaN of none. */
function extremes(value: Float32Array, begin: number, end: number): [number, number] {
  let [low, high] = [-1, -1];
  for (let place = begin; place < end; place++) {
    const now = value[place]!;
    if (Number.isNaN(now)) continue;
    if (low < 0 || now < value[low]!) low = place;
    if (high < 0 || now > value[high]!) high = place;
  }
  if (low < 0) return [NaN, NaN];
  return low <= high ? [value[low]!, value[high]!] : [value[high]!, value[low]!];
}

/** The place of the first time after this one. */
function firstAfter(time: Float64Array, seconds: number): number {
  let [low, high] = [0, time.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (time[middle]! <= seconds) low = middle + 1;
    else high = middle;
  }
  return low;
}
