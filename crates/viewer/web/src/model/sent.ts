/** What a subject sends: what any sample of the last moment held, since single datagrams get lost. */

import { Flag, type SubjectRecord } from '../protocol/types';

export class Sent {
  /** When each flag was last seen, seconds of the source's clock. */
  private readonly seen = new Map<number, number>();
  private newest = NaN;
  private timecode: { value: number; at: number } | null = null;

  take(record: SubjectRecord): void {
    const { time, flags } = record;
    // A source that was started again, or a playhead that was moved.
    if (!(Math.abs(time - this.newest) < LONGEST_STEP)) this.forget();
    this.newest = time;
    for (const flag of FLAGS) if (flags & flag) this.seen.set(flag, time);
    if (Number.isFinite(record.timecode)) this.timecode = { value: record.timecode, at: time };
  }

  /** The bits of `Flag` that are to be told of. Positions that were sent outdo those in place. */
  flags(): number {
    const flags = [...this.seen].reduce((sum, [flag, at]) => (this.newest - at < MEMORY ? sum | flag : sum), 0);
    return flags & Flag.Positions ? flags & ~Flag.InPlace : flags;
  }

  /** The timecode of the newest sample in seconds of the day, counted on where it has none; NaN without any. */
  timeOfDay(): number {
    if (!this.timecode || this.newest - this.timecode.at >= MEMORY) return NaN;
    return this.timecode.value + this.newest - this.timecode.at;
  }

  private forget(): void {
    this.seen.clear();
    this.timecode = null;
  }
}

const FLAGS = [Flag.Positions, Flag.Orientations, Flag.InPlace];

/** Seconds that something is held to be sent still. */
const MEMORY = 1;
/** Seconds between two samples of which one follows from the other. */
const LONGEST_STEP = 2;
