/** Draws the timeline: a lane for each take, its gaps as holes, its markers as ticks, and a scale of times. */

import type { Take } from '../protocol/types';
import { clock } from '../model/format';
import { type Span, frameTime, gapSpans } from './timeline';

export interface TrackColors {
  lane: string;
  gap: string;
  marker: string;
  text: string;
}

/** Draws everything that does not move. The canvas is sized to its element first. */
export function drawTrack(canvas: HTMLCanvasElement, takes: Take[], span: Span, colors: TrackColors): void {
  const { width, height } = fit(canvas);
  const context = canvas.getContext('2d');
  if (!context) return;
  context.scale(canvas.width / width, canvas.height / height);
  context.clearRect(0, 0, width, height);
  drawScale(context, span, width, height, colors.text);
  const room = height - SCALE;
  const lanes = Math.min(takes.length, Math.max(Math.floor(room / 5), 1));
  const lane = room / lanes;
  takes.forEach((take, place) => {
    const top = (place % lanes) * lane;
    drawLane(context, take, span, { width, top, height: lane - 1 }, colors);
  });
}

interface Lane {
  width: number;
  top: number;
  height: number;
}

function drawLane(context: CanvasRenderingContext2D, take: Take, span: Span, lane: Lane, colors: TrackColors): void {
  const x = (seconds: number): number => place(seconds, span) * lane.width;
  const from = x(take.start_s);
  const to = x(frameTime(take, Math.max(take.frames - 1, 0)));
  context.fillStyle = colors.lane;
  context.beginPath();
  context.roundRect(from, lane.top, Math.max(to - from, 2), lane.height, 3);
  context.fill();
  context.fillStyle = colors.gap;
  for (const gap of gapSpans(take)) {
    // A gap of one sample in an hour is still seen.
    context.fillRect(x(gap.from), lane.top, Math.max(x(gap.to) - x(gap.from), 2), lane.height);
  }
  context.fillStyle = colors.marker;
  for (const marker of take.markers) drawMarker(context, x(frameTime(take, marker.frame)), lane);
}

/** A flag: a line with a small triangle at its top. */
function drawMarker(context: CanvasRenderingContext2D, x: number, lane: Lane): void {
  context.fillRect(x - 0.75, lane.top, 1.5, lane.height);
  context.beginPath();
  context.moveTo(x, lane.top);
  context.lineTo(x + 6, lane.top + 3.5);
  context.lineTo(x, lane.top + 7);
  context.fill();
}

function drawScale(context: CanvasRenderingContext2D, span: Span, width: number, height: number, color: string): void {
  const length = span.to - span.from;
  const step = roundStep(length, width / 80);
  context.fillStyle = color;
  context.font = '11px system-ui, sans-serif';
  for (let time = 0; step > 0 && time <= length + 1e-9; time += step) {
    const x = (time / length) * width;
    context.globalAlpha = 0.5;
    context.fillRect(Math.min(x, width - 1), height - SCALE + 1, 1, 4);
    context.globalAlpha = 1;
    context.textAlign = x < 20 ? 'left' : x > width - 20 ? 'right' : 'center';
    context.fillText(clock(time, step < 1 ? 1 : 0), x, height - 1);
  }
}

/** Seconds between labels: 1, 2 or 5 of a power of ten below a minute, then what a clock has. */
export function roundStep(length: number, labels: number): number {
  const wanted = length / Math.max(labels, 1);
  return STEPS.find((step) => step >= wanted) ?? Math.ceil(wanted / 3600) * 3600;
}

/** From 0 at the beginning of the span to 1 at its end. */
export function place(seconds: number, span: Span): number {
  const length = span.to - span.from;
  return length > 0 ? (seconds - span.from) / length : 0;
}

function fit(canvas: HTMLCanvasElement): { width: number; height: number } {
  const { clientWidth: width, clientHeight: height } = canvas;
  canvas.width = Math.round(width * devicePixelRatio);
  canvas.height = Math.round(height * devicePixelRatio);
  return { width: Math.max(width, 1), height: Math.max(height, 1) };
}

/** The height of the labels under the lanes. */
const SCALE = 17;
const STEPS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600];
