import { describe, expect, it } from 'vitest';
import { bytes, clock, hertz, milliseconds, secondsOfDay, timeOfDay } from './format';
import { StatisticsHistory, losses, streamKey } from './history';
import { Room } from './room';
import type { SourceStatistics, StreamStatistics } from '../protocol/statistics';
import type { Scene, Subject, SubjectRecord } from '../protocol/types';

describe('numbers', () => {
  it('are as long as they need to be', () => {
    expect([240.04, 59.94, 1].map(hertz)).toEqual(['240 Hz', '59.9 Hz', '1 Hz']);
    expect([1.26, 12.6, null].map(milliseconds)).toEqual(['1.3 ms', '13 ms', '–']);
    expect([512, 1234, 56_789_000].map(bytes)).toEqual(['512 B', '1.2 kB', '56.8 MB']);
  });

  it('carry over at the end of a minute, an hour and a day', () => {
    expect([0, 59.9996, 3599.9, 3723.004].map((seconds) => clock(seconds))).toEqual([
      '0:00.000',
      '1:00.000',
      '59:59.900',
      '1:02:03.004',
    ]);
    expect([86_399.996, 36_672.34].map((seconds) => timeOfDay(seconds))).toEqual(['00:00:00.00', '10:11:12.34']);
    expect(secondsOfDay('10:11:12.345')).toBeCloseTo(36_672.345);
    expect(secondsOfDay('noon')).toBeNull();
  });
});

const pose = {
  character: 0,
  name: 'Ada',
  type: '02',
  rate_hz: 240,
  missing: 3,
  samples: { done: 90, partial: 2, gone: 1 },
};
const source = {
  source: 0,
  receiver: { kernel_dropped: 4 },
  subjects: [pose, { ...pose, type: '20' }],
  server: null,
} as unknown as SourceStatistics;

describe('statistics', () => {
  it('count what a second lost, and forget after two minutes', () => {
    const history = new StatisticsHistory();
    const key = streamKey(source, source.subjects[0]!);
    for (const missing of [3, 7, 6, 6]) {
      const subjects = [{ ...pose, missing } as StreamStatistics];
      history.add({ sources: [{ ...source, subjects }], page: { connections: 1, skipped: 0 } });
    }
    expect(history.seconds(key).map((second) => second.missing)).toEqual([0, 4, 0, 0]);
    for (let second = 0; second < 130; second++)
      history.add({ sources: [source], page: { connections: 1, skipped: 0 } });
    expect(history.seconds(key)).toHaveLength(120);
  });

  it('say where samples were lost, each character once', () => {
    expect(losses(source)).toEqual({ kernel: 4, partial: 2, gone: 1, frames: 0 });
  });
});

describe('the room', () => {
  it('forgets who left', () => {
    const room = new Room();
    const subjects = [{ id: 0 }, { id: 1 }] as Subject[];
    room.describe({ mode: 'live', subjects, takes: [] } as unknown as Scene);
    room.take([{ id: 1, state: 0 } as SubjectRecord]);
    room.hidden.add(1);
    room.followed = 1;
    room.describe({ mode: 'live', subjects: [subjects[0]], takes: [] } as unknown as Scene);
    expect([room.records.size, room.hidden.size, room.followed]).toEqual([0, 0, null]);
  });

  it('says a notice that comes again once', () => {
    const room = new Room();
    ['a', 'a', 'b'].forEach((text) => room.notice(text));
    expect(room.notices.map(({ text, times }) => [text, times])).toEqual([
      ['b', 1],
      ['a', 2],
    ]);
  });
});
