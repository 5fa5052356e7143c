import { type Color, Quaternion, Vector3 } from 'three';
import { Sent } from '../model/sent';
import { Flag, State, type Subject, type SubjectRecord } from '../protocol/types';
import { bodyParts } from './body';
import { describedNullPose } from './body/null_pose';
import type { Part } from './body/part';
import { type Roles, roles } from './body/roles';
import { Seen, ShownPose } from './body/shown_pose';
import { subjectColor } from './palette';
import { Trail } from './trail';

/** One subject on the stage: its body and where it is. */
export class Performer {
  readonly color: Color;
  readonly roles: Roles | null;
  readonly pose: ShownPose;
  readonly trails: Map<number, Trail>;
  parts: Part[];
  record: SubjectRecord | null = null;
  private readonly sent = new Sent();

  constructor(readonly subject: Subject) {
    this.color = subjectColor(subject);
    this.roles = roles(subject.segments);
    this.pose = new ShownPose(subject.segments, describedNullPose(subject.segments), BERTH * subject.id);
    this.parts = bodyParts(subject, this.pose.nullPose);
    this.trails = new Map(trailed(subject, this.roles).map((place) => [place, new Trail()]));
  }

  take(record: SubjectRecord): void {
    this.record = record;
    this.sent.take(record);
    if (this.pose.take(record)) this.parts = bodyParts(this.subject, this.pose.nullPose);
    for (const [place, trail] of this.trails) {
      if (this.pose.seen[place] === Seen.Now) trail.add(...this.place(place), record.time);
    }
  }

  get state(): State {
    return this.record?.state ?? State.Live;
  }

  /** Where a segment's origin is drawn. */
  place(segment: number): [number, number, number] {
    const { position } = this.pose;
    return [position[3 * segment] ?? NaN, position[3 * segment + 1] ?? NaN, position[3 * segment + 2] ?? NaN];
  }

  origin(segment: number, into = new Vector3()): Vector3 {
    return into.fromArray(this.pose.position, 3 * segment);
  }

  turn(segment: number, into = new Quaternion()): Quaternion {
    const turn = this.pose.orientation;
    const at = 4 * segment;
    return into.set(turn[at + 1] ?? 0, turn[at + 2] ?? 0, turn[at + 3] ?? 0, turn[at] ?? 1);
  }

  /** A point that hangs on a segment, in the room. */
  point(segment: number, offset: Vector3): Vector3 {
    return offset.clone().applyQuaternion(this.turn(segment)).add(this.origin(segment));
  }

  /** Where to look when this one is followed: the middle of the body; null while nothing of it was seen. */
  centre(): Vector3 | null {
    const at = this.origin(this.roles?.pelvis ?? 0);
    if (Number.isFinite(at.x)) return at;
    return this.middle();
  }

  /** Points around where it is and may be with its next steps. */
  room(): Vector3[] {
    const outline = this.outline();
    const centre = this.centre();
    if (!centre) return outline;
    const beside = outline.flatMap(({ z }) =>
      STEP.flatMap((dx) => STEP.map((dy) => new Vector3(centre.x + dx, centre.y + dy, z))),
    );
    return [...outline, ...beside];
  }

  /** The way its front looks, as an angle about the vertical from +X; 0 while nobody knows. */
  facing(): number {
    const forward = new Vector3(1, 0, 0).applyQuaternion(this.turn(this.roles?.pelvis ?? 0));
    const level = Math.hypot(forward.x, forward.y);
    return level > 0.2 ? Math.atan2(forward.y, forward.x) : 0;
  }

  /** The place over the highest of it, for its name. */
  top(): Vector3 | null {
    const head = this.roles?.head ?? -1;
    if (this.pose.seen[head]) return this.origin(head).add(new Vector3(0, 0, 0.25));
    const highest = this.shown().reduce<Vector3 | null>((best, at) => (best && best.z >= at.z ? best : at), null);
    return highest?.clone().add(new Vector3(0, 0, 0.16)) ?? null;
  }

  /** Points around all that is shown of it: bodies reach a little past their segments' origins. */
  outline(): Vector3[] {
    return this.shown().flatMap((at) => [
      at.clone().add(new Vector3(0.12, 0.12, 0.14)),
      at.clone().sub(new Vector3(0.12, 0.12, 0.09)),
    ]);
  }

  /** What the tag says under the name. */
  note(): string {
    const flags = this.sent.flags();
    const never = this.pose.count(Seen.Never);
    if (never > 0 && never === this.pose.seen.length) return 'not tracked yet';
    const notes = [];
    if (flags & Flag.InPlace) notes.push('orientations only, in place');
    else if (flags & Flag.Positions && !(flags & Flag.Orientations)) notes.push('positions only');
    const lost = this.pose.count(Seen.Before);
    if (never > 0) notes.push(`${segments(never)} never tracked`);
    if (lost > 0) notes.push(`${segments(lost)} not tracked`);
    return notes.join(' · ');
  }

  private middle(): Vector3 | null {
    const points = this.shown();
    return points.length === 0
      ? null
      : points.reduce((sum, at) => sum.add(at), new Vector3()).divideScalar(points.length);
  }

  private shown(): Vector3[] {
    const points = [...this.pose.seen].flatMap((seen, place) => (seen === Seen.Never ? [] : [this.origin(place)]));
    const markers = this.record?.markers ?? new Float32Array();
    for (let at = 0; at + 2 < markers.length; at += 3) {
      if (Number.isFinite(markers[at])) points.push(new Vector3().fromArray(markers, at));
    }
    return points;
  }
}

/** Metres to each side of a performer that are its room. */
const STEP = [-0.5, 0.5];

/** Metres between subjects of which nobody knows where they are. */
const BERTH = 1.2;

function segments(count: number): string {
  return count === 1 ? '1 segment' : `${count} segments`;
}

/** The segments that leave trails: of a person head, hands, feet and pelvis, else whatever nothing hangs on. */
function trailed(subject: Subject, person: Roles | null): number[] {
  if (person) {
    const ends = [person.left, person.right].flatMap((side) => [side.hand, side.toe ?? side.foot]);
    return [person.pelvis, person.head, ...ends];
  }
  const parents = new Set(subject.segments.map((segment) => segment.parent));
  return subject.segments.flatMap((_, place) => (parents.has(place) ? [] : [place])).slice(0, 6);
}
