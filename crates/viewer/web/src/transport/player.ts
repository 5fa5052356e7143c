/** Plays takes: keeps the playhead going, and hands on the frames that are to be seen. */

import { TakeFrames } from '../protocol/takes';
import { State, type SubjectRecord, type Take } from '../protocol/types';
import { Playhead } from './playhead';
import { type Span, frameAt, frameTime, nearestFrame, wholeSpan } from './timeline';

export class Player {
  readonly span: Span;
  readonly playhead: Playhead;
  private readonly frames: TakeFrames[];
  /** The frame of each take that was handed on last. */
  private readonly shown = new Map<number, number>();
  private direction: 1 | -1 = 1;
  private before = 0;

  /** `show` gets the records of the frames that have changed. */
  constructor(
    readonly takes: Take[],
    private readonly show: (records: SubjectRecord[]) => void,
  ) {
    this.span = wholeSpan(takes);
    this.playhead = new Playhead(this.span);
    this.frames = takes.map((take) => new TakeFrames(take, () => this.update()));
    this.update();
    requestAnimationFrame((now) => this.run(now));
  }

  /** The take whose frames are stepped and numbered: the first. */
  get leading(): Take | undefined {
    return this.takes[0];
  }

  /** The frame of the leading take at the playhead. */
  frame(): number {
    return this.leading ? nearestFrameBefore(this.leading, this.playhead.position) : 0;
  }

  /** The frame that the leading take shows, once it has come. */
  shownFrame(): number | null {
    const shown = this.leading && this.shown.get(this.leading.id);
    return shown === undefined ? null : shown < 0 ? -1 - shown : shown;
  }

  seek(seconds: number): void {
    this.direction = seconds < this.playhead.position ? -1 : 1;
    this.playhead.seek(seconds);
    this.update();
  }

  /** Goes to a frame of the leading take, and stays there. */
  goTo(frame: number): void {
    if (this.leading) this.goToOf(this.leading, frame);
  }

  /** The same of any take. */
  goToOf(take: Take, frame: number): void {
    this.playhead.playing = false;
    const last = Math.max(take.frames - 1, 0);
    this.seek(frameTime(take, Math.min(Math.max(Math.round(frame), 0), last)));
  }

  step(frames: number): void {
    this.goTo(this.frame() + frames);
  }

  private run(now: number): void {
    // A page that was asleep goes on where it was; one that draws slowly keeps its time.
    const passed = (now - (this.before || now)) / 1000;
    this.before = now;
    if (this.playhead.advance(passed > ASLEEP ? 0 : passed)) {
      this.direction = 1;
      this.update();
    }
    requestAnimationFrame((next) => this.run(next));
  }

  /** Hands on what is new at the playhead. Frames that are still on their way come with a later call. */
  private update(): void {
    const records: SubjectRecord[] = [];
    this.frames.forEach((frames) => {
      const { take } = frames;
      const wanted = this.takes.length === 1 ? this.frame() : frameAt(take, this.playhead.position);
      const place = wanted < 0 ? nearestFrame(take, this.playhead.position) : wanted;
      const record = frames.frame(place, this.direction);
      // The first frame is another thing before the take than in it.
      const shown = wanted < 0 ? -1 - place : place;
      if (!record || this.shown.get(take.id) === shown) return;
      this.shown.set(take.id, shown);
      records.push(wanted < 0 ? away(record) : record);
    });
    if (records.length > 0) this.show(records);
  }
}

/** Seconds without a frame of the screen after which a page was asleep. */
const ASLEEP = 3;

/** The last frame that has come by a time, the first or last outside of the take. */
function nearestFrameBefore(take: Take, seconds: number): number {
  const frame = frameAt(take, seconds);
  return frame >= 0 ? frame : nearestFrame(take, seconds);
}

/** Outside of its take a subject keeps its first or last pose, without colour. */
function away(record: SubjectRecord): SubjectRecord {
  return { ...record, state: State.Away };
}
