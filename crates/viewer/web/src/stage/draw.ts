import { Color, Quaternion, Vector3 } from 'three';
import { Flag, State } from '../protocol/types';
import { isFinger } from './body/hand';
import type { Part } from './body/part';
import { Seen } from './body/shown_pose';
import type { Brush } from './brush';
import { contacts } from './contacts';
import type { StageOptions } from './options';
import type { Performer } from './performer';
import type { Look } from './room/theme';
import { type Tones, tones } from './tones';

/** How one subject is to be drawn. */
export interface Manner {
  look: Look;
  options: StageOptions;
  /** How strong the soft shadows under it are. */
  soft: number;
  /** Whether the view goes along with it. */
  followed: boolean;
  /** How many pixels high a person is where it stands. */
  pixels: number;
  /** Whether there is time for many triangles. */
  lavish: boolean;
}

/** Draws one subject with all that the options ask for. */
export function draw(performer: Performer, brush: Brush, manner: Manner): void {
  const { look, options, soft } = manner;
  const colors = tones(performer.color, performer.state, look);
  drawParts(performer, brush, colors, manner);
  drawObject(performer, brush, colors);
  drawGround(performer, brush, look, colors, soft);
  if (manner.followed) drawFollowed(performer, brush, colors);
  if (options.axes || performer.subject.kind === 'rigid body') drawAxes(performer, brush, manner.pixels);
  if (options.trails) drawTrails(performer, brush, colors);
  if (options.com) drawCenterOfMass(performer, brush, look);
  if (options.markers) drawMarkers(performer, brush, look, colors);
}

/** Whether a segment is drawn as what it is, as a ghost, or not at all. */
function presence(performer: Performer, segment: number): number {
  const seen = performer.pose.seen[segment] ?? Seen.Never;
  return performer.state === State.Lost ? Math.min(seen, Seen.Before) : seen;
}

function drawParts(performer: Performer, brush: Brush, colors: Tones, { pixels, lavish }: Manner): void {
  const body =
    pixels < TINY ? brush.tiny : pixels < SMALL ? brush.far : pixels > LARGE && lavish ? brush.close : brush.near;
  for (const part of performer.parts) {
    if (part.fine && pixels < TINY) continue;
    const seen = presence(performer, part.segment);
    if (seen === Seen.Never) continue;
    const batch = seen === Seen.Before ? brush.ghost : part.fine ? brush.fine : body;
    batch.add(
      part,
      start(performer, part),
      turn(performer, part),
      seen === Seen.Before ? colors.accent : colors[part.tone],
    );
  }
}

/** Persons of fewer pixels are drawn with fewer triangles, and still smaller ones without fingers. */
const SMALL = 210;
const TINY = 75;
/** From here on the edges of triangles would be seen. */
const LARGE = 480;

const PLACE = new Vector3();
const TURN = new Quaternion();
const HELD = new Quaternion();

function start(performer: Performer, part: Part): Vector3 {
  return PLACE.copy(part.at).applyQuaternion(performer.turn(part.segment, HELD)).add(performer.origin(part.segment));
}

function turn(performer: Performer, part: Part): Quaternion {
  return performer.turn(part.segment, TURN).multiply(part.turn);
}

/** A rigid body: a box around its points, or of the size of a hand. */
function drawObject(performer: Performer, brush: Brush, colors: Tones): void {
  if (performer.subject.kind !== 'rigid body') return;
  performer.subject.segments.forEach((segment, place) => {
    const seen = presence(performer, place);
    const [middle, size] = extent(segment.points.map((point) => new Vector3(...point.offset)));
    const at = performer.point(place, middle);
    if (seen === Seen.Now) brush.boxes.add(at, performer.turn(place), size, colors.suit);
    if (seen === Seen.Before) brush.ghost.addBall(at, size.length() / 3, colors.accent);
  });
}

function extent(points: Vector3[]): [middle: Vector3, size: Vector3] {
  const low = points.reduce((least, point) => least.min(point), new Vector3(-0.045, -0.045, -0.045));
  const high = points.reduce((most, point) => most.max(point), new Vector3(0.045, 0.045, 0.045));
  return [low.clone().add(high).multiplyScalar(0.5), high.sub(low)];
}

/** Soft shadows where the body is close to the ground, and the contacts of the feet. */
function drawGround(performer: Performer, brush: Brush, look: Look, colors: Tones, soft: number): void {
  const strength = performer.state === State.Lost ? soft * 0.3 : soft;
  for (const segment of grounded(performer)) {
    if (performer.pose.seen[segment] === Seen.Never) continue;
    const [x, y, z] = performer.place(segment);
    const near = 1 - Math.min(Math.max(z, 0) / 1.3, 1);
    const radius = 0.17 + 0.36 * Math.min(Math.max(z, 0), 1.3);
    if (near > 0.02 && z > -0.3) brush.disks.add(x, y, 0.001, radius, look.shade, strength * near * near);
  }
  for (const { x, y, z } of contacts(performer)) {
    brush.disks.add(x, y, z, 0.13, colors.glow, 0.55);
    brush.disks.add(x, y, z, 0.09, colors.glow, 0.5, 'ring');
  }
}

/** A ring around whom the view goes along with. */
function drawFollowed(performer: Performer, brush: Brush, colors: Tones): void {
  const at = performer.centre();
  if (at) brush.disks.add(at.x, at.y, 0.0015, 0.5, colors.accent, 0.34, 'ring');
}

function grounded(performer: Performer): number[] {
  const { roles, subject } = performer;
  if (!roles) return subject.segments.map((_, place) => place).slice(0, 40);
  const limbs = [roles.left, roles.right].flatMap(({ foot, toe, lowerLeg, hand }) => [
    foot,
    toe ?? foot,
    lowerLeg,
    hand,
  ]);
  return [roles.pelvis, roles.head, ...limbs];
}

const AXES: [Vector3, Color][] = [
  [new Vector3(1, 0, 0), new Color('#e8504f')],
  [new Vector3(0, 1, 0), new Color('#4fb267')],
  [new Vector3(0, 0, 1), new Color('#4c8dff')],
];

/** The local axes of segments whose orientation was sent. */
function drawAxes(performer: Performer, brush: Brush, pixels: number): void {
  if (!performer.pose.turned) return;
  const width = Math.min(Math.max(pixels / 130, 1), 2);
  performer.subject.segments.forEach((segment, place) => {
    if (presence(performer, place) !== Seen.Now || (isFinger(segment) && pixels < SMALL)) return;
    const length = isFinger(segment) ? 0.018 : performer.subject.kind === 'rigid body' ? 0.16 : 0.1;
    const at = performer.place(place);
    for (const [axis, color] of AXES) {
      const tip = performer.point(place, axis.clone().multiplyScalar(length));
      brush.topLines.add(at, tip.toArray(), color, isFinger(segment) ? 0.6 * width : width, 0.95);
    }
  });
}

function drawTrails(performer: Performer, brush: Brush, colors: Tones): void {
  for (const [place, trail] of performer.trails) {
    if (presence(performer, place) === Seen.Now) trail.draw(brush.lines, colors.glow, performer.place(place));
  }
}

const GOLD = new Color('#ffd15c');

/** The centre of mass through the body, and where it is over the ground. An estimate is paler. */
function drawCenterOfMass(performer: Performer, brush: Brush, look: Look): void {
  const at = new Vector3().fromArray(performer.record?.centerOfMass ?? [NaN, NaN, NaN]);
  if (!Number.isFinite(at.x) || performer.state === State.Lost) return;
  const estimated = ((performer.record?.flags ?? 0) & Flag.EstimatedCenterOfMass) !== 0;
  const color = estimated ? GOLD.clone().lerp(look.object, 0.55) : GOLD;
  brush.inner.addBall(at, 0.042, look.visor);
  brush.inner.addBall(at, 0.034, color);
  brush.topLines.add([at.x, at.y, at.z - 0.04], [at.x, at.y, 0], color, 1.6, 0.9, 0.55);
  brush.disks.add(at.x, at.y, 0.003, 0.11, color, 0.95, 'ring');
  brush.disks.add(at.x, at.y, 0.003, 0.05, color, 0.9);
}

function drawMarkers(performer: Performer, brush: Brush, look: Look, colors: Tones): void {
  const markers = performer.record?.markers ?? new Float32Array();
  const color = look.marker.clone().lerp(colors.accent, performer.subject.kind === 'markers' ? 0.35 : 0.12);
  for (let at = 0; at + 2 < markers.length; at += 3) {
    if (!Number.isFinite(markers[at])) continue;
    brush.balls.addBall(PLACE.fromArray(markers, at), 0.011, color);
  }
}
