import type { Segment } from '../../protocol/types';

/** One arm's and one leg's segments, by their places. */
export interface Limbs {
  shoulder: number | null;
  upperArm: number;
  foreArm: number;
  hand: number;
  upperLeg: number;
  lowerLeg: number;
  foot: number;
  toe: number | null;
}

/** Which segment is which part of a person. */
export interface Roles {
  pelvis: number;
  /** From the pelvis (without it) up to the neck (without it). */
  spine: number[];
  neck: number;
  head: number;
  left: Limbs;
  right: Limbs;
}

/** The roles of a skeleton that is a person's, by the names that MVN and Motive give; null for all other skeletons. */
export function roles(segments: Segment[]): Roles | null {
  const places = new Map(segments.map((segment, place) => [bare(segment.name), place]));
  const find = (...names: string[]) =>
    names.map((name) => places.get(name)).find((place) => place !== undefined) ?? null;
  const limbs = (long: string, short: string) => ({
    shoulder: find(`${long}shoulder`, `${short}shoulder`),
    upperArm: find(`${long}upperarm`, `${short}uarm`, `${long}arm`),
    foreArm: find(`${long}forearm`, `${short}farm`),
    hand: find(`${long}hand`, `${short}hand`),
    upperLeg: find(`${long}upperleg`, `${short}thigh`, `${long}upleg`),
    lowerLeg: find(`${long}lowerleg`, `${short}shin`, `${long}leg`),
    foot: find(`${long}foot`, `${short}foot`),
    toe: find(`${long}toe`, `${short}toe`, `${long}toebase`),
  });
  const pelvis = find('pelvis', 'hip', 'hips');
  const [neck, head] = [find('neck'), find('head')];
  const [left, right] = [limbs('left', 'l'), limbs('right', 'r')];
  if (pelvis === null || neck === null || head === null || !whole(left) || !whole(right)) return null;
  return { pelvis, spine: spine(segments, pelvis, neck), neck, head, left, right };
}

/** A name without what Motive puts before it: `Ada_LThigh`, `Ada:LeftUpLeg`. */
function bare(name: string): string {
  return name.slice(Math.max(name.lastIndexOf('_'), name.lastIndexOf(':')) + 1).toLowerCase();
}

type Found = { [Name in keyof Limbs]: number | null };

function whole(limbs: Found): limbs is Found & Limbs {
  return Object.entries(limbs).every(([name, place]) => place !== null || name === 'shoulder' || name === 'toe');
}

function spine(segments: Segment[], pelvis: number, neck: number): number[] {
  const chain: number[] = [];
  let place = segments[neck]?.parent ?? null;
  while (place !== null && place !== pelvis && chain.length < segments.length) {
    chain.unshift(place);
    place = segments[place]?.parent ?? null;
  }
  return chain;
}
