import type { SubjectRecord } from '../protocol/types';

/** Whether two samples of a subject look the same: the server tells of those who stand still, or are lost, too. */
export function looksSame(a: SubjectRecord, b: SubjectRecord): boolean {
  return (
    a.time === b.time &&
    a.state === b.state &&
    a.flags === b.flags &&
    a.contacts === b.contacts &&
    equal(a.position, b.position) &&
    equal(a.orientation, b.orientation) &&
    equal(a.centerOfMass, b.centerOfMass) &&
    equal(a.markers, b.markers)
  );
}

/** Number by number; what is not tracked in both is the same. */
function equal(a: Float32Array, b: Float32Array): boolean {
  return a.length === b.length && a.every((value, at) => Object.is(value, b[at]));
}
