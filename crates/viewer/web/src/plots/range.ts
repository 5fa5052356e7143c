/** The range of a chart's values: ends on round numbers, so that it stands still while values move a little. */

export function niceRange(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
  // A value that does not move is a line in the middle, at a scale that shows it is still.
  const size = Math.max(high - low, Math.abs(high) * 1e-3, 0.01);
  const step = niceStep(size / 4);
  const from = Math.floor((low - size * 0.04) / step) * step;
  const to = Math.ceil((high + size * 0.04) / step) * step;
  return [from, to];
}

/** 1, 2 or 5 times a power of ten, at least this. */
function niceStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  const factor = [1, 2, 5, 10].find((each) => each * power >= least * (1 - 1e-9)) ?? 10;
  return factor * power;
}
