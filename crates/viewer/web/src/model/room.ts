/** All that the page knows: who is there, their newest samples, and what the person at the page chose. */

import type { Connection } from '../protocol/live';
import type { Recorder, Statistics } from '../protocol/statistics';
import { type Scene, State, type Subject, type SubjectRecord, type Take } from '../protocol/types';
import { StatisticsHistory } from './history';
import { Sent } from './sent';

export interface Notice {
  /** When it came, milliseconds since 1970. */
  at: number;
  text: string;
  /** How often it came in a row. */
  times: number;
}

export class Room {
  scene: Scene | null = null;
  /** The newest sample of each subject that has one. */
  readonly records = new Map<number, SubjectRecord>();
  private readonly sent = new Map<number, Sent>();
  readonly hidden = new Set<number>();
  followed: number | null = null;
  /** Goes up with each change of who is there, or of who is hidden or followed. */
  revision = 0;

  connection: Connection = 'connecting';
  /** When the next attempt to connect is made, milliseconds since 1970. */
  retryAt = 0;
  /** Why the server lets this page in nowhere, in its words; null while it does. */
  refusal: string | null = null;
  /** Whether the source has come to its end. */
  ended = false;

  statistics: Statistics | null = null;
  readonly history = new StatisticsHistory();
  readonly notices: Notice[] = [];
  recorder: Recorder | null = null;

  /** Takes a description; those who left are forgotten. */
  describe(scene: Scene): void {
    this.scene = scene;
    this.refusal = null;
    this.ended = false;
    const ids = new Set(scene.subjects.map((subject) => subject.id));
    for (const held of [this.records, this.sent]) for (const id of held.keys()) if (!ids.has(id)) held.delete(id);
    for (const id of this.hidden) if (!ids.has(id)) this.hidden.delete(id);
    if (this.followed !== null && !ids.has(this.followed)) this.followed = null;
    this.revision++;
  }

  take(records: SubjectRecord[]): void {
    for (const record of records) {
      this.records.set(record.id, record);
      const sent = this.sent.get(record.id) ?? new Sent();
      sent.take(record);
      this.sent.set(record.id, sent);
    }
  }

  /** What a subject sends, as the bits of `Flag`; null before its first sample. */
  flags(id: number): number | null {
    return this.sent.get(id)?.flags() ?? null;
  }

  /** The timecode of a subject's newest sample in seconds of the day; NaN when it sends none. */
  timecode(id: number): number {
    return this.sent.get(id)?.timeOfDay() ?? NaN;
  }

  count(statistics: Statistics): void {
    this.statistics = statistics;
    this.history.add(statistics);
  }

  notice(text: string): void {
    const last = this.notices[0];
    if (last?.text === text) {
      last.times++;
      last.at = Date.now();
      return;
    }
    this.notices.unshift({ at: Date.now(), text, times: 1 });
    this.notices.length = Math.min(this.notices.length, NOTICES_KEPT);
  }

  get subjects(): Subject[] {
    return this.scene?.subjects ?? [];
  }

  get takes(): Take[] {
    return this.scene?.takes ?? [];
  }

  get live(): boolean {
    return this.scene?.mode === 'live';
  }

  subject(id: number): Subject | undefined {
    return this.subjects.find((subject) => subject.id === id);
  }

  takeOf(subject: number): Take | undefined {
    return this.takes.find((take) => take.subject === subject);
  }

  /** The state that the server judged, or null before the first sample. */
  state(id: number): State | null {
    return this.records.get(id)?.state ?? null;
  }

  /** Samples a second: as measured, as long as they come; else as announced. */
  rate(subject: Subject): number | null {
    const take = this.takeOf(subject.id);
    if (take) return take.rate_hz;
    if (this.state(subject.id) !== State.Live) return null;
    return this.measuredRate(subject) ?? subject.rate_hz;
  }

  private measuredRate(subject: Subject): number | null {
    const source = this.statistics?.sources.find((each) => each.source === subject.source);
    const streams = source?.subjects ?? [];
    const own = streams.filter((stream) => stream.type === 'frame' || stream.name === subject.name);
    const rates = own.map((stream) => stream.rate_hz).filter((rate) => rate > 0);
    return rates.length > 0 ? Math.max(...rates) : null;
  }
}

const NOTICES_KEPT = 50;
