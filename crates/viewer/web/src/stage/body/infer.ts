import { Matrix4, Quaternion, Vector3 } from 'three';
import type { Segment } from '../../protocol/types';
import { type NullPose, offset } from './null_pose';

/**
 * Orientations that agree with positions alone, so that a body of type 21 can be drawn with volume.
 *
 * Where two joints hang on a segment they say how it is turned; where one does, the segment turns with its parent and
 * then the shortest way; where none does, it turns with its parent. Twists are a guess, directions are not.
 */
export class Inference {
  private readonly ways: Way[][];
  private readonly order: number[];

  constructor(
    private readonly segments: Segment[],
    pose: NullPose,
  ) {
    this.ways = segments.map((_, place) => waysFrom(segments, pose, place));
    this.order = parentsFirst(segments);
  }

  /** Fills the orientations (w, x, y, z) that are NaN where the segment's position is known. */
  fill(position: Float32Array, orientation: Float32Array): void {
    for (const place of this.order) {
      if (Number.isFinite(orientation[4 * place]) || !Number.isFinite(position[3 * place])) continue;
      const parent = this.segments[place]?.parent ?? null;
      const start = (parent === null ? null : read(orientation, parent)) ?? new Quaternion();
      const turn = turned(start, this.visible(place, position));
      orientation.set([turn.w, turn.x, turn.y, turn.z], 4 * place);
    }
  }

  /** The joints of a segment that can be seen: where they are in the null pose, and where now. */
  private visible(place: number, position: Float32Array): { rest: Vector3; now: Vector3 }[] {
    const from = new Vector3().fromArray(position, 3 * place);
    return (this.ways[place] ?? []).flatMap(({ to, rest }) => {
      const now = new Vector3().fromArray(position, 3 * to).sub(from);
      return Number.isFinite(now.x) && now.lengthSq() > 1e-8 ? [{ rest, now }] : [];
    });
  }
}

interface Way {
  to: number;
  rest: Vector3;
}

function turned(start: Quaternion, joints: { rest: Vector3; now: Vector3 }[]): Quaternion {
  const [first, second] = mostApart(joints);
  if (!first) return start;
  if (second) return frame(first.now, second.now).multiply(frame(first.rest, second.rest).invert());
  const before = first.rest.clone().applyQuaternion(start).normalize();
  return new Quaternion().setFromUnitVectors(before, first.now.clone().normalize()).multiply(start);
}

/** The two joints whose directions say most, or one where all lie on a line. */
function mostApart<J extends { rest: Vector3 }>(joints: J[]): [J?, J?] {
  let best: [J?, J?] = [joints[0]];
  let least = 0.9;
  joints.forEach((a, i) => {
    for (const b of joints.slice(i + 1)) {
      const along = Math.abs(a.rest.clone().normalize().dot(b.rest.clone().normalize()));
      if (along < least) [best, least] = [[a, b], along];
    }
  });
  return best;
}

function frame(a: Vector3, b: Vector3): Quaternion {
  const x = a.clone().normalize();
  const z = x.clone().cross(b).normalize();
  return new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(x, z.clone().cross(x), z));
}

function waysFrom(segments: Segment[], pose: NullPose, place: number): Way[] {
  return segments.flatMap((segment, to) => {
    const rest = segment.parent === place && segment.kind !== 'prop' ? offset(segments, pose, to) : null;
    return rest && rest.lengthSq() > 1e-8 ? [{ to, rest }] : [];
  });
}

function parentsFirst(segments: Segment[]): number[] {
  const depth = segments.map((_, place) => {
    let steps = 0;
    for (let at: number | null = place; at !== null && steps <= segments.length; steps += 1)
      at = segments[at]?.parent ?? null;
    return steps;
  });
  return segments.map((_, place) => place).sort((a, b) => (depth[a] ?? 0) - (depth[b] ?? 0));
}

function read(orientation: Float32Array, place: number): Quaternion | null {
  const [w, x, y, z] = orientation.subarray(4 * place, 4 * place + 4);
  const turn = new Quaternion(x, y, z, w);
  return Number.isFinite(turn.lengthSq()) ? turn : null;
}
