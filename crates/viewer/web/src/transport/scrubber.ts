/** The timeline as a slider: drawn once, with a playhead and a range that move over it. */

import { h, setAttribute } from '../dom/h';
import { clock } from '../model/format';
import type { Take } from '../protocol/types';
import type { Playhead } from './playhead';
import { type Span, frameTime } from './timeline';
import { drawTrack, place } from './track';

export interface Scrubber {
  element: HTMLElement;
  /** Moves the playhead and the range to where they are. */
  refresh(): void;
  /** Draws the track anew: its size or the colours have changed. */
  redraw(): void;
}

export function scrubber(takes: Take[], span: Span, playhead: Playhead, seek: (seconds: number) => void): Scrubber {
  const canvas = h('canvas', { class: 'track', 'aria-hidden': 'true' });
  const range = h('div', { class: 'range', hidden: true });
  const head = h('div', { class: 'playhead' });
  const tip = h('div', { class: 'tip', hidden: true });
  const element = h(
    'div',
    { class: 'scrubber', role: 'slider', tabindex: '0', 'aria-label': 'Timeline', 'aria-valuemin': '0' },
    canvas,
    range,
    head,
    tip,
  );
  setAttribute(element, 'aria-valuemax', (span.to - span.from).toFixed(3));

  const redraw = (): void => {
    const style = getComputedStyle(element);
    const color = (name: string): string => style.getPropertyValue(name).trim();
    const colors = { lane: color('--lane'), gap: color('--gap'), marker: color('--marker'), text: color('--muted') };
    drawTrack(canvas, takes, span, colors);
  };
  const refresh = (): void => {
    head.style.left = `${100 * place(playhead.position, span)}%`;
    range.hidden = playhead.range === null;
    const { from, to } = playhead.bounds();
    range.style.left = `${100 * place(from, span)}%`;
    range.style.width = `${100 * (place(to, span) - place(from, span))}%`;
    const now = playhead.position - span.from;
    setAttribute(element, 'aria-valuenow', now.toFixed(3));
    setAttribute(element, 'aria-valuetext', clock(now));
  };
  listen(element, span, seek);
  hints(element, tip, takes, span);
  new ResizeObserver(redraw).observe(element);
  refresh();
  return { element, refresh, redraw };
}

/** Pressing goes there, drawing scrubs. */
function listen(element: HTMLElement, span: Span, seek: (seconds: number) => void): void {
  const go = (event: PointerEvent): void => seek(timeAt(element, span, event));
  element.addEventListener('pointerdown', (event) => {
    if (event.button !== 0) return;
    element.setPointerCapture(event.pointerId);
    go(event);
  });
  element.addEventListener('pointermove', (event) => element.hasPointerCapture(event.pointerId) && go(event));
}

/** Under the pointer: the time, and the marker that is near. */
function hints(element: HTMLElement, tip: HTMLElement, takes: Take[], span: Span): void {
  element.addEventListener('pointermove', (event) => {
    const time = timeAt(element, span, event);
    const near = nearestMarker(takes, time, ((span.to - span.from) * 8) / element.clientWidth);
    tip.hidden = false;
    tip.textContent = near ? `${near}, ${clock(time - span.from)}` : clock(time - span.from);
    tip.style.left = `${100 * place(time, span)}%`;
  });
  element.addEventListener('pointerleave', () => (tip.hidden = true));
}

function timeAt(element: HTMLElement, span: Span, event: PointerEvent): number {
  const { left, width } = element.getBoundingClientRect();
  const part = Math.min(Math.max((event.clientX - left) / width, 0), 1);
  return span.from + part * (span.to - span.from);
}

function nearestMarker(takes: Take[], time: number, within: number): string | null {
  let best: { name: string; distance: number } | null = null;
  for (const take of takes) {
    for (const { frame, name } of take.markers) {
      const distance = Math.abs(frameTime(take, frame) - time);
      if (distance <= within && distance < (best?.distance ?? Infinity)) best = { name, distance };
    }
  }
  return best?.name ?? null;
}
