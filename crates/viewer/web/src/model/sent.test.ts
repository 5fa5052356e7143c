import { expect, it } from 'vitest';
import { Flag, type SubjectRecord } from '../protocol/types';
import { Sent } from './sent';

const record = (time: number, flags: number, timecode = NaN) => ({ time, flags, timecode }) as SubjectRecord;
const both = Flag.Positions | Flag.Orientations;

it('does not follow single samples that lack something', () => {
  const sent = new Sent();
  sent.take(record(10, both, 3600));
  sent.take(record(10.1, Flag.Positions));
  expect(sent.flags()).toBe(both);
  expect(sent.timeOfDay()).toBeCloseTo(3600.1);
  sent.take(record(10.2, Flag.Orientations | Flag.InPlace));
  expect(sent.flags()).toBe(both);
});

it('tells of what is lacking for longer', () => {
  const sent = new Sent();
  for (let time = 0; time <= 1; time += 0.25) sent.take(record(time, time === 0 ? both : Flag.Positions, 5));
  expect(sent.flags()).toBe(Flag.Positions);
});

it('forgets when the clock begins anew', () => {
  const sent = new Sent();
  sent.take(record(100, both, 7));
  sent.take(record(0, Flag.Orientations | Flag.InPlace));
  expect(sent.flags()).toBe(Flag.Orientations | Flag.InPlace);
  expect(sent.timeOfDay()).toBeNaN();
});
