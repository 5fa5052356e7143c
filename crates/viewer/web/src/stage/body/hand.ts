import { Vector3 } from 'three';
import type { Segment } from '../../protocol/types';
import { type NullPose, offset } from './null_pose';
import { type Part, type Section, part } from './part';
import type { Limbs } from './roles';

/** The parts of all finger segments that the skeleton has: each a small rounded bone to the next joint. */
export function fingers(segments: Segment[], pose: NullPose, size: number): Part[] {
  return segments.flatMap((segment, place) => (isFinger(segment) ? finger(segments, pose, size, place) : []));
}

/** Fingers for a hand whose fingers are not captured: a flat, slightly bent mitten with a thumb, fixed to the hand. */
export function mitten(hand: Limbs['hand'], out: Vector3, size: number): Part[] {
  const at = (forward: number, outward: number, up: number) =>
    out
      .clone()
      .normalize()
      .multiplyScalar(outward * size)
      .add(new Vector3(forward * size, 0, up * size));
  const finger = (forward: number, knuckle: number, tip: number) =>
    part(hand, at(forward, knuckle, -0.002), at(forward * 1.05, tip, -0.012), {
      start: [0.0105 * size, 0.0105 * size],
      end: [0.0085 * size, 0.0085 * size],
      bow: -0.004 * size,
      tone: 'skin',
      fine: true,
    });
  return [
    finger(0.028, 0.085, 0.165),
    finger(0.009, 0.09, 0.178),
    finger(-0.01, 0.087, 0.168),
    finger(-0.028, 0.08, 0.145),
    part(hand, at(0.022, 0.028, -0.006), at(0.058, 0.09, -0.012), {
      start: [0.015 * size, 0.015 * size],
      end: [0.0095 * size, 0.0095 * size],
      tone: 'skin',
      fine: true,
    }),
  ];
}

/** True for a segment of a hand's fingers. */
export function isFinger(segment: Segment): boolean {
  return segment.kind === 'left finger' || segment.kind === 'right finger';
}

function finger(segments: Segment[], pose: NullPose, size: number, place: number): Part[] {
  const children = segments.flatMap((segment, child) => (segment.parent === place ? [child] : []));
  // The carpus branches to all fingers; the palm stands for it.
  if (children.length > 1) return [];
  const way = children[0] === undefined ? tip(segments, pose, place) : offset(segments, pose, children[0]);
  if (!way || way.length() < 1e-4) return [];
  return [part(place, new Vector3(), way, { ...shape(segments, place, size), tone: 'skin', fine: true })];
}

/** The last bone of a finger has no next joint: it goes on as the one before, a little shorter. */
function tip(segments: Segment[], pose: NullPose, place: number): Vector3 | null {
  const way = offset(segments, pose, place);
  return way ? way.multiplyScalar(0.72) : null;
}

function shape(segments: Segment[], place: number, size: number): { start: Section; end: Section } {
  const depth = bonesBefore(segments, place);
  const radius = (FINGER_RADII[depth] ?? 0.008) * size;
  const next = (FINGER_RADII[depth + 1] ?? 0.007) * size;
  return { start: [radius, radius], end: [next, next] };
}

/** How many bones of the finger come before: 0 for the metacarpal. */
function bonesBefore(segments: Segment[], place: number): number {
  let depth = -1;
  let at: number | null = place;
  while (at !== null && depth < 4) {
    const segment: Segment | undefined = segments[at];
    if (!segment || !isFinger(segment)) break;
    at = segment.parent;
    depth += 1;
  }
  return Math.max(depth - 1, 0);
}

const FINGER_RADII = [0.0125, 0.0105, 0.0092, 0.0084, 0.0074];
