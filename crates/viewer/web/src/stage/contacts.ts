import { Vector3 } from 'three';
import { Flag, State } from '../protocol/types';
import { Seen } from './body/shown_pose';
import type { Performer } from './performer';

/** Where the body touches the ground now, by the contacts that are set: on the ground under heel or toe. */
export function contacts(performer: Performer): Vector3[] {
  const { record, subject } = performer;
  if (!record || record.state === State.Lost || !(record.flags & Flag.Contacts)) return [];
  return subject.contacts.flatMap((name, bit) => {
    const at = (record.contacts >>> bit) & 1 ? touching(performer, name) : null;
    return at ? [at] : [];
  });
}

/** `LeftFoot_Heel`: the point of the segment `LeftFoot` that is its heel. */
function touching(performer: Performer, contact: string): Vector3 | null {
  const [segmentName, spot] = split(contact);
  const { segments } = performer.subject;
  const foot = segments.findIndex((segment) => segment.name === segmentName);
  const toe = segments.findIndex((segment) => segment.parent === foot);
  const [place, fallback] = spot === 'Toe' && toe >= 0 ? [toe, TOE] : [foot, spot === 'Heel' ? HEEL : SOLE];
  if (place < 0 || performer.pose.seen[place] !== Seen.Now) return null;
  const point = segments[place]?.points.find(({ name }) => ENDS[spot]?.some((end) => name.endsWith(end)));
  const at = performer.point(place, point ? new Vector3(...point.offset) : fallback);
  // On the ground where that is what it touches, on a step where it is not.
  return at.setZ(Math.abs(at.z) < 0.12 ? 0.002 : at.z);
}

function split(contact: string): [segment: string, spot: string] {
  const at = contact.lastIndexOf('_');
  return at < 0 ? [contact, ''] : [contact.slice(0, at), contact.slice(at + 1)];
}

const ENDS: Record<string, string[]> = { Heel: ['HeelFoot', 'HeelCenter'], Toe: ['Toe'] };
const HEEL = new Vector3(-0.04, 0, -0.08);
const TOE = new Vector3(0.04, 0, -0.01);
const SOLE = new Vector3(0.04, 0, -0.08);
