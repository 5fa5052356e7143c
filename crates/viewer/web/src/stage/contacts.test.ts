import { expect, test } from 'vitest';
import { contacts } from './contacts';
import { Performer } from './performer';
import { nominalSegments, subjectOf, tPose } from './testing/nominal';

const segments = nominalSegments();

test('a contact is drawn on the ground under its foot', () => {
  const performer = new Performer(subjectOf(segments));
  performer.take({ ...tPose(segments, [2, 0, 0]), flags: 3 | 16, contacts: 0b0001 });
  const [heel, ...others] = contacts(performer);
  expect(others).toEqual([]);
  expect(heel?.toArray()).toEqual([expect.closeTo(1.96, 4), expect.closeTo(0.09, 4), 0.002]);
});

test('contacts that are not known are not drawn', () => {
  const performer = new Performer(subjectOf(segments));
  performer.take({ ...tPose(segments), flags: 3, contacts: 0b1111 });
  expect(contacts(performer)).toEqual([]);
});

test('the tag says what a stream lacks', () => {
  const performer = new Performer(subjectOf(segments));
  const record = tPose(segments);
  expect(performer.note()).toBe('not tracked yet');
  performer.take(record);
  expect(performer.note()).toBe('');
  performer.take({ ...record, time: record.time + 10, flags: 1 });
  expect(performer.note()).toBe('positions only');
  performer.take({ ...record, time: record.time + 20, flags: 2 | 4 });
  expect(performer.note()).toBe('orientations only, in place');
  const position = record.position.slice().fill(NaN, 0, 3);
  performer.take({ ...record, position });
  expect(performer.note()).toBe('1 segment not tracked');
});
