import { Flag, type Segment, type SubjectRecord } from '../../protocol/types';
import { inPlace } from './in_place';
import { Inference } from './infer';
import { type NullPose, observedNullPose } from './null_pose';

/** How a segment is to be drawn. */
export const Seen = { Never: 0, Before: 1, Now: 2 } as const;

/**
 * Where the segments of one subject are drawn: where they are, and those that are not tracked where they were last.
 *
 * Never at the origin: what was never seen is marked as such and has no place.
 */
export class ShownPose {
  readonly position: Float32Array;
  /** w, x, y, z. */
  readonly orientation: Float32Array;
  readonly seen: Uint8Array;
  /** Whether the last sample said how segments are turned; if not, `orientation` is a guess. */
  turned = false;
  private inference: Inference;
  private untilObserved = 0;

  constructor(
    private readonly segments: Segment[],
    public nullPose: NullPose,
    /** How far aside it stands when it streams orientations alone, metres along Y. */
    private readonly aside = 0,
  ) {
    this.position = new Float32Array(3 * segments.length).fill(NaN);
    this.orientation = new Float32Array(4 * segments.length).fill(NaN);
    this.seen = new Uint8Array(segments.length);
    this.inference = new Inference(segments, nullPose);
  }

  /** Takes a sample in. True when it showed another null pose than was known, so that bodies must be built anew. */
  take(record: SubjectRecord): boolean {
    const turns = record.orientation.slice();
    const position = record.flags & Flag.InPlace ? inPlace(record.position, this.aside) : record.position;
    this.turned = turns.some(Number.isFinite);
    const grown = this.observe(position, turns);
    this.inference.fill(position, turns);
    for (let place = 0; place < this.segments.length; place += 1) this.place(place, position, turns);
    return grown;
  }

  /** How many of the segments are drawn in each way of `Seen`. */
  count(seen: number): number {
    return this.seen.reduce((sum, one) => sum + (one === seen ? 1 : 0), 0);
  }

  private place(place: number, position: Float32Array, orientation: Float32Array): void {
    const tracked = 3 * place + 2 < position.length && finite(position, 3 * place, 3);
    if (!tracked) {
      if (this.seen[place] === Seen.Now) this.seen[place] = Seen.Before;
      return;
    }
    this.seen[place] = Seen.Now;
    this.position.set(position.subarray(3 * place, 3 * place + 3), 3 * place);
    const turn = finite(orientation, 4 * place, 4) ? orientation.subarray(4 * place, 4 * place + 4) : null;
    if (turn) this.orientation.set(turn, 4 * place);
    else if (!Number.isFinite(this.orientation[4 * place])) this.orientation.set([1, 0, 0, 0], 4 * place);
  }

  /** Now and then, for a scaled skeleton can be described after the first samples, or never. */
  private observe(position: Float32Array, orientation: Float32Array): boolean {
    this.untilObserved -= 1;
    if (this.untilObserved > 0) return false;
    this.untilObserved = OBSERVE_EVERY;
    const observed = observedNullPose(this.segments, this.nullPose, position, orientation);
    if (!observed) return false;
    this.nullPose = observed;
    this.inference = new Inference(this.segments, observed);
    return true;
  }
}

const OBSERVE_EVERY = 30;

function finite(values: Float32Array, from: number, count: number): boolean {
  for (let at = from; at < from + count; at += 1) if (!Number.isFinite(values[at])) return false;
  return true;
}
