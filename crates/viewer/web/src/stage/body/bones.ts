import { Vector3 } from 'three';
import type { Segment } from '../../protocol/types';
import { type NullPose, offset } from './null_pose';
import { type Part, part } from './part';

/** Parts of a skeleton of which nothing is known but how it hangs together: a tapered bone to each child. */
export function bones(segments: Segment[], pose: NullPose): Part[] {
  return segments.flatMap((segment, place) =>
    segment.kind === 'prop' ? [] : ways(segments, pose, place).map((way) => bone(place, way)),
  );
}

/** A held prop: a rod through the hand, as long as its points say. */
export function prop(segment: Segment, place: number): Part {
  const reach = Math.max(...segment.points.map((point) => Math.hypot(...point.offset)), 0);
  const ahead = new Vector3(reach > 0.05 ? reach : 0.32, 0, 0);
  return part(place, ahead.clone().multiplyScalar(-0.25), ahead, {
    start: [0.013, 0.013],
    end: [0.016, 0.016],
    tone: 'object',
  });
}

function ways(segments: Segment[], pose: NullPose, place: number): Vector3[] {
  const children = segments.flatMap((segment, child) => (segment.parent === place ? [child] : []));
  const found = children.flatMap((child) => offset(segments, pose, child) ?? []).filter((way) => way.length() > 1e-3);
  return found.length > 0 ? found : leaf(segments, pose, place);
}

/** What hangs on nothing further: it goes on a little in its parent's direction, or is a knob. */
function leaf(segments: Segment[], pose: NullPose, place: number): Vector3[] {
  const way = offset(segments, pose, place);
  return [way && way.length() > 1e-3 ? way.multiplyScalar(0.45) : new Vector3(0, 0, 0.02)];
}

function bone(place: number, way: Vector3): Part {
  const radius = Math.min(Math.max(way.length() * 0.13, 0.01), 0.055);
  return part(place, new Vector3(), way, {
    start: [radius, radius],
    end: [radius * 0.7, radius * 0.7],
    tone: 'suit',
    fine: radius < 0.014,
  });
}
