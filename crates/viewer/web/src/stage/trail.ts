import type { Color } from 'three';
import type { Lines } from './batch/lines';

/** The way that one joint went in the last seconds. */
export class Trail {
  private points: number[] = [];
  private times: number[] = [];

  /** Adds where the joint is at a time of the source; what is older than the trail is long falls off. */
  add(x: number, y: number, z: number, time: number): void {
    const last = this.times.at(-1);
    if (last !== undefined && (time < last || time - last > JUMP)) this.clear();
    if (last !== undefined && time - last < SPACING && time >= last) return;
    if (!Number.isFinite(x + y + z)) return;
    this.points.push(x, y, z);
    this.times.push(time);
    const old = this.times.findIndex((one) => time - one <= SECONDS);
    if (old > 0) {
      this.times.splice(0, old);
      this.points.splice(0, 3 * old);
    }
  }

  clear(): void {
    this.points.length = this.times.length = 0;
  }

  /** Draws it, from nothing at its oldest to its colour at its newest point and on to where the joint is now. */
  draw(lines: Lines, color: Color, now: [number, number, number]): void {
    const count = this.times.length;
    const at = (place: number): number[] => this.points.slice(3 * place, 3 * place + 3);
    const fade = (place: number) => (place / count) ** 1.4 * 0.85;
    for (let place = 0; place + 1 < count; place += 1)
      lines.add(at(place), at(place + 1), color, 2.2, fade(place), fade(place + 1));
    if (count > 0) lines.add(at(count - 1), now, color, 2.2, fade(count - 1), 0.85);
  }
}

/** How long a trail is. */
const SECONDS = 2.5;
/** The least time between two of its points. */
const SPACING = 1 / 32;
/** A longer gap is another movement: a seek, a dropout. */
const JUMP = 0.6;
