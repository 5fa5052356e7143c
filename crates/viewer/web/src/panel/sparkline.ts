/** A line of the last two minutes, with a mark under each second that lost something. */

import { s, setAttribute } from '../dom/h';
import type { Second } from '../model/history';

export interface Sparkline {
  element: SVGSVGElement;
  show(seconds: readonly Second[]): void;
}

export function sparkline(): Sparkline {
  const line = s('polyline', { class: 'line' });
  const marks = s('path', { class: 'losses' });
  const box = `0 0 ${WIDTH} ${HEIGHT}`;
  const element = s('svg', { class: 'sparkline', viewBox: box, preserveAspectRatio: 'none', role: 'img' }, line, marks);
  const show = (seconds: readonly Second[]): void => {
    setAttribute(line, 'points', points(seconds));
    setAttribute(marks, 'd', lossMarks(seconds));
    setAttribute(element, 'aria-label', summary(seconds));
  };
  return { element, show };
}

/** From zero to the highest rate, so that a line at the top is steady and one that falls has fallen. */
export function points(seconds: readonly Second[]): string {
  const highest = Math.max(...seconds.map((second) => second.rate), 1e-9);
  const y = (rate: number): number => TOP + (1 - rate / highest) * (HEIGHT - TOP - 4.5);
  return seconds.map((second, place) => `${x(place, seconds)},${y(second.rate).toFixed(1)}`).join(' ');
}

function lossMarks(seconds: readonly Second[]): string {
  const marks = seconds.map((second, place) => (second.missing > 0 ? `M${x(place, seconds)} ${HEIGHT - 3}v3` : ''));
  return marks.join('');
}

/** The newest second is at the right. What is short is drawn as if it were half a minute, to be seen at all. */
function x(place: number, seconds: readonly Second[]): string {
  const step = (WIDTH - 2) / (Math.max(seconds.length, 30) - 1);
  return (WIDTH - 1 - (seconds.length - 1 - place) * step).toFixed(1);
}

function summary(seconds: readonly Second[]): string {
  if (seconds.length === 0) return 'No history yet';
  const rates = seconds.map((second) => second.rate);
  const lossy = seconds.filter((second) => second.missing > 0).length;
  const [low, high] = [Math.min(...rates), Math.max(...rates)].map(Math.round);
  return `${low} to ${high} a second over the last ${seconds.length} s, losses in ${lossy} of them`;
}

const WIDTH = 120;
const HEIGHT = 24;
/** Where a steady rate is: beside the text of its row, not above it. */
const TOP = 8;
