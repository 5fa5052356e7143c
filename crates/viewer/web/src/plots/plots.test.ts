import { describe, expect, it } from 'vitest';
import { channelKey, findChannel, search, suggestions, title } from './channels';
import { niceRange } from './range';
import { Rolling } from './rolling';
import { table, valueAt } from './table';
import { thin } from './thin';
import type { Subject } from '../protocol/types';

const subjects = [
  {
    id: 0,
    name: 'Ada',
    channels: [
      { section: 'position', entries: ['Pelvis', 'Head'], axes: ['x', 'y', 'z'], unit: 'm' },
      { section: 'joint_angles', entries: ['jRightKnee', 'jLeftKnee'], axes: ['x', 'y', 'z'], unit: 'deg' },
    ],
  },
  { id: 1, name: 'Bea', channels: [{ section: 'position', entries: ['Pelvis'], axes: ['x', 'y', 'z'], unit: 'm' }] },
] as unknown as Subject[];

describe('channels', () => {
  it('are found by words of their name, their subject and what their axis is called', () => {
    const names = (text: string) => search(subjects, text, 20).map(channelKey);
    expect(names('knee flexion')).toEqual(['0:joint_angles/jRightKnee/z', '0:joint_angles/jLeftKnee/z']);
    expect(names('bea PELVIS y')).toEqual(['1:position/Pelvis/y']);
    expect(names('joint_angles left abduction')).toEqual(['0:joint_angles/jLeftKnee/x']);
    expect(search(subjects, '', 4)).toHaveLength(4);
    const nameless = { ...subjects[1], id: 4, name: '', kind: 'person' } as Subject;
    expect(search([nameless], 'person 5 pelvis', 4)).toHaveLength(3);
  });

  it('are found by what they are called on the page and by what the server calls them', () => {
    const groups = [
      { section: 'center_of_mass', entries: ['CoM'], axes: ['x', 'y', 'z'], unit: 'm' },
      { section: 'angular_velocity', entries: ['RightUpperArm'], axes: ['x', 'y', 'z'], unit: 'deg/s' },
    ];
    const performer = [{ id: 0, name: 'Ada', channels: groups }] as unknown as Subject[];
    const names = (text: string) => search(performer, text, 20).map(title);
    expect(names('centre of mass z')).toEqual(['Centre of mass z']);
    expect(names('center_of_mass/CoM/z')).toEqual(['Centre of mass z']);
    expect(names('right upper arm angular velocity x')).toEqual(['RightUpperArm angular velocity x']);
    expect(names('m/s')).toEqual([]);
  });

  it('are found again by their key, and suggested', () => {
    const knee = findChannel(subjects, '0:joint_angles/jRightKnee/z')!;
    expect([knee.unit, title(knee)]).toEqual(['deg', 'jRightKnee flexion']);
    expect(findChannel(subjects, '7:position/Pelvis/x')).toBeUndefined();
    expect(suggestions(subjects).map(channelKey)).toEqual([
      '0:position/Pelvis/z',
      '0:joint_angles/jRightKnee/z',
      '0:joint_angles/jLeftKnee/z',
      '1:position/Pelvis/z',
    ]);
  });
});

describe('a rolling window', () => {
  it('keeps the last seconds, however many samples come', () => {
    const rolling = new Rolling(2);
    for (let sample = 0; sample < 5000; sample += 5) {
      const times = Float64Array.from({ length: 5 }, (_, place) => (sample + place) / 240);
      rolling.push(
        times,
        Float32Array.from(times, (time) => time * 2),
      );
    }
    expect(rolling.times()).toHaveLength(481);
    expect(rolling.times()[480]).toBe(4999 / 240);
    expect(rolling.values()[0]).toBeCloseTo((4519 / 240) * 2, 4);
  });

  it('begins anew when time goes back', () => {
    const rolling = new Rolling(2);
    rolling.push(Float64Array.of(100, 101), Float32Array.of(1, 2));
    rolling.push(Float64Array.of(0, 0.5), Float32Array.of(3, 4));
    expect([...rolling.values()]).toEqual([3, 4]);
  });
});

describe('a table', () => {
  const a = { time: Float64Array.of(0, 1, 2), value: Float32Array.of(5, NaN, 7) };
  const b = { time: Float64Array.of(0.5, 1), value: Float32Array.of(8, 9) };

  it('shares times that are the same, with holes for what is unknown', () => {
    expect(table([a, { ...a, time: a.time.slice() }])).toEqual([a.time, [5, null, 7], [5, null, 7]]);
  });

  it('joins times that differ', () => {
    const [times, first, second] = table([a, b]);
    expect(times).toEqual([0, 0.5, 1, 2]);
    expect([first![1], second![0], second![2]]).toEqual([undefined, undefined, 9]);
    expect(first![2]).toBeNull();
  });

  it('knows the value at a time', () => {
    expect([-1, 0, 0.9, 2, 9].map((time) => valueAt(a, time))).toEqual([null, 5, 5, 7, 7]);
    expect(valueAt(a, 1.5)).toBeNull();
  });
});

describe('the range of a chart', () => {
  it('ends on round numbers around the values', () => {
    expect(niceRange(3, 58)).toEqual([0, 80]);
    const [low, high] = niceRange(0.869, 0.9055);
    expect([low, high].map((value) => value.toFixed(3))).toEqual(['0.860', '0.910']);
  });

  it('has room for a value that does not move, and for none', () => {
    const [low, high] = niceRange(5, 5);
    expect(low).toBeLessThan(5);
    expect(high).toBeGreaterThan(5);
    expect(niceRange(null, null)).toEqual([0, 1]);
  });
});

describe('a long channel', () => {
  const time = Float64Array.from({ length: 100_000 }, (_, sample) => sample / 100);
  const value = Float32Array.from(time, (_, sample) =>
    sample === 54_321 ? 9 : sample === 54_325 ? -9 : Math.sin(sample),
  );
  const column = { time, value };

  it('keeps its peaks, and the times that others share', () => {
    const thinned = thin(column, 0, 1000, 500);
    expect(thinned.time.length).toBeLessThanOrEqual(1002);
    expect([Math.max(...thinned.value), Math.min(...thinned.value)]).toEqual([9, -9]);
    expect(thinned.value.indexOf(9)).toBeLessThan(thinned.value.indexOf(-9));
    expect(thin({ time, value: value.map((each) => -each) }, 0, 1000, 500).time).toEqual(thinned.time);
    expect([...thinned.time]).toEqual([...thinned.time].sort((a, b) => a - b));
  });

  it('is whole where it is seen closely, with a sample on each side', () => {
    const seen = thin(column, 500.005, 500.025, 500);
    expect([...seen.time]).toEqual([500, 500.01, 500.02, 500.03]);
  });

  it('has a hole where nothing is known', () => {
    const holed = { time, value: value.map((each, sample) => (sample < 50_000 ? NaN : each)) };
    const thinned = thin(holed, 0, 1000, 100);
    expect(thinned.value.slice(0, 100).every(Number.isNaN)).toBe(true);
    expect(thinned.value.slice(110).some(Number.isNaN)).toBe(false);
  });
});
