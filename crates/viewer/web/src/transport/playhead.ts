/** Where a take is played, and how: time on the timeline, speed, and the range that is repeated. */

import type { Span } from './timeline';

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4] as const;

export class Playhead {
  /** Seconds on the timeline. */
  position: number;
  playing = false;
  speed = 1;
  /** Whether it begins again at the end of the range, or of everything. */
  repeat = false;
  /** The range that is played, or null for everything. */
  range: Span | null = null;

  constructor(private span: Span) {
    this.position = span.from;
  }

  /** Goes on by so many seconds of the wall's clock. Says whether it moved. */
  advance(seconds: number): boolean {
    if (!this.playing) return false;
    const { from, to } = this.bounds();
    this.position += seconds * this.speed;
    if (this.position < from) this.position = from;
    if (this.position >= to) this.atEnd(from, to);
    return true;
  }

  /** Plays or pauses; from the end it begins again. */
  toggle(): void {
    const { from, to } = this.bounds();
    this.playing = !this.playing;
    if (this.playing && this.position >= to) this.position = from;
  }

  /** Goes somewhere within the whole timeline, playing or not. */
  seek(seconds: number): void {
    this.position = Math.min(Math.max(seconds, this.span.from), this.span.to);
  }

  /** The next speed that is offered, or the one before. */
  changeSpeed(direction: 1 | -1): void {
    const place = SPEEDS.indexOf(this.speed as (typeof SPEEDS)[number]);
    this.speed = SPEEDS[Math.min(Math.max(place + direction, 0), SPEEDS.length - 1)] ?? 1;
  }

  /** Begins the range here, or ends it here; a range that would be empty or backwards is begun anew. */
  mark(edge: 'from' | 'to'): void {
    const range = { ...this.bounds(), [edge]: this.position };
    if (range.from < range.to) this.range = range;
    else
      this.range = edge === 'from' && this.position < this.span.to ? { from: this.position, to: this.span.to } : null;
    this.repeat = this.range !== null;
  }

  /** Everything is played again, once. */
  clearRange(): void {
    this.range = null;
    this.repeat = false;
  }

  bounds(): Span {
    return this.range ?? this.span;
  }

  private atEnd(from: number, to: number): void {
    const length = to - from;
    if (this.repeat && length > 0) {
      this.position = from + ((this.position - from) % length);
    } else {
      this.position = to;
      this.playing = false;
    }
  }
}
