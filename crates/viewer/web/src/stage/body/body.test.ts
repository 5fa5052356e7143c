import { Vector3 } from 'three';
import { expect, test } from 'vitest';
import { nominalSegments, subjectOf } from '../testing/nominal';
import { bodyParts } from '.';
import { describedNullPose } from './null_pose';
import type { Part } from './part';
import { roles } from './roles';

const segments = nominalSegments();
const pose = describedNullPose(segments);
const parts = bodyParts(subjectOf(segments), pose);

test('every segment of a body has volume', () => {
  const drawn = new Set(parts.map((part) => part.segment));
  expect([...drawn].sort((a, b) => a - b)).toEqual(segments.map((_, place) => place));
});

test('in the T-pose a body stands on the ground and is as high as an adult', () => {
  const heights = parts.flatMap((part) => reach(part).map((point) => point.z));
  expect(Math.min(...heights)).toBeGreaterThan(-0.012);
  expect(Math.min(...heights)).toBeLessThan(0.012);
  expect(Math.max(...heights)).toBeGreaterThan(1.7);
  expect(Math.max(...heights)).toBeLessThan(1.8);
});

test('the left half mirrors the right one', () => {
  const side = (name: string) => parts.filter((part) => segments[part.segment]?.name.startsWith(name)).map(size);
  expect(side('Left')).toEqual(side('Right'));
});

test('a limb goes from its joint to the next', () => {
  const forearm = parts.find((part) => segments[part.segment]?.name === 'LeftForeArm');
  expect(forearm?.length).toBeCloseTo(0.25, 5);
  expect(along(forearm as Part).y).toBeCloseTo(1, 5);
});

test('a child has a smaller body than an adult', () => {
  const small = describedNullPose(segments).map((origin) => origin?.multiplyScalar(0.6) ?? null);
  const child = bodyParts(subjectOf(segments), small);
  child.forEach((part, place) => expect(part.start[0]).toBeLessThan(parts[place]?.start[0] ?? 0));
});

test('a skeleton of unknown names is drawn by its bones', () => {
  const unknown = segments.map((segment, place) => ({ ...segment, name: `bone ${place}` }));
  expect(roles(unknown)).toBeNull();
  const bones = bodyParts({ ...subjectOf(unknown), kind: 'skeleton' }, describedNullPose(unknown));
  expect(bones.length).toBeGreaterThanOrEqual(segments.length);
});

test("the names of Motive's skeletons are a person's too", () => {
  const names = ['Hip', 'Ab', 'Chest', 'Neck', 'Head'];
  const sides = ['L', 'R'].flatMap((side) =>
    ['Shoulder', 'UArm', 'FArm', 'Hand', 'Thigh', 'Shin', 'Foot', 'Toe'].map((name) => side + name),
  );
  const actor = [...names, ...sides].map((name, place) => ({
    ...(segments[0] ?? { origin: null, points: [], kind: 'body' as const }),
    name: `Ada_${name}`,
    parent: place > 0 && place < 5 ? place - 1 : null,
  }));
  expect(roles(actor)?.spine).toEqual([1, 2]);
  expect(roles(actor)?.left.lowerLeg).toBe(10);
});

/** Both ends of a part and their outermost points along the vertical. */
function reach(part: Part): Vector3[] {
  const origin = pose[part.segment] ?? new Vector3();
  const ends: [number, [number, number], number][] = [
    [0, part.start, part.caps[0]],
    [part.length, part.end, part.caps[1]],
  ];
  return ends.flatMap(([x, [broad, deep], cap]) =>
    [
      new Vector3(x === 0 ? -cap : x + cap, 0, 0),
      new Vector3(x, broad, 0),
      new Vector3(x, -broad, 0),
      new Vector3(x, 0, deep),
      new Vector3(x, 0, -deep),
    ].map((point) => point.applyQuaternion(part.turn).add(part.at).add(origin)),
  );
}

function along(part: Part): Vector3 {
  return new Vector3(1, 0, 0).applyQuaternion(part.turn);
}

function size(part: Part): number[] {
  return [part.length, ...part.start, ...part.end, ...part.caps].map((value) => Math.round(value * 1e6));
}
