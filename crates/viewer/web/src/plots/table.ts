/** Channels with times of their own as one table, which is what a chart draws. */

/** A channel's samples. */
export interface Column {
  time: Float64Array;
  value: Float32Array;
}

/** The times, then the values of each column, null where a column has no sample and NaN is unknown. */
export type Table = [Float64Array | number[], ...(number | null)[][]];

/** One table of all columns. Where all have the same times, as those of one subject have, nothing is sorted. */
export function table(columns: Column[]): Table {
  const first = columns[0];
  if (!first) return [[]];
  if (columns.every((column) => sameTimes(column.time, first.time))) {
    return [first.time, ...columns.map(({ value }) => Array.from(value, known))];
  }
  const times = [...new Set(columns.flatMap((column) => [...column.time]))].sort((a, b) => a - b);
  return [times, ...columns.map((column) => spread(column, times))];
}

/** The value at the last sample that has come by a time, or null. */
export function valueAt({ time, value }: Column, seconds: number): number | null {
  let [low, high] = [0, time.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (time[middle]! <= seconds) low = middle + 1;
    else high = middle;
  }
  return low > 0 ? known(value[low - 1]!) : null;
}

function spread({ time, value }: Column, times: number[]): (number | null)[] {
  // Undefined is where this column has no sample, which a line is drawn across; null is a hole.
  const values = new Array<number | null>(times.length);
  for (let place = 0, at = 0; place < times.length && at < time.length; place++) {
    if (times[place] === time[at]) values[place] = known(value[at++]!);
  }
  return values;
}

function sameTimes(a: Float64Array, b: Float64Array): boolean {
  return a === b || (a.length === b.length && a[0] === b[0] && a[a.length - 1] === b[b.length - 1]);
}

function known(value: number): number | null {
  return Number.isFinite(value) ? value : null;
}
