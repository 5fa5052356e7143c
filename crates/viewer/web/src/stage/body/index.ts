import type { Subject } from '../../protocol/types';
import { bones, prop } from './bones';
import { fingers, isFinger, mitten } from './hand';
import { human, scale } from './human';
import { type NullPose, offset } from './null_pose';
import type { Part } from './part';
import { type Roles, roles } from './roles';

/** Everything that a subject's body is made of, in its segments' axes: a person where the names say so, else bones. */
export function bodyParts(subject: Subject, pose: NullPose): Part[] {
  const { segments } = subject;
  if (subject.kind === 'rigid body' || subject.kind === 'markers') return [];
  const person = roles(segments);
  const props = segments.flatMap((segment, place) => (segment.kind === 'prop' ? [prop(segment, place)] : []));
  if (!person || !known(pose, person)) return [...bones(segments, pose), ...props];
  const size = scale(pose, person);
  return [...human(segments, pose, person), ...hands(subject, pose, person, size), ...props];
}

function hands(subject: Subject, pose: NullPose, person: Roles, size: number): Part[] {
  const { segments } = subject;
  const captured = fingers(segments, pose, size);
  const empty = (['left', 'right'] as const).filter(
    (side) => !segments.some((segment) => isFinger(segment) && segment.kind === `${side} finger`),
  );
  const drawn = empty.flatMap((side) => {
    const out = offset(segments, pose, person[side].hand);
    return out ? mitten(person[side].hand, out, size) : [];
  });
  return [...captured, ...drawn];
}

/** Whether the null pose has every place that a person's shape is made from. */
function known(pose: NullPose, person: Roles): boolean {
  const { left, right, spine } = person;
  const limbs = [left, right].flatMap((side) => Object.values(side) as (number | null)[]);
  return [person.pelvis, person.neck, person.head, ...spine, ...limbs].every(
    (place) => place === null || !!pose[place],
  );
}
