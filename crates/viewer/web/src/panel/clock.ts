/** The time in large figures: the timecode that was sent, else the source's clock. Of takes, with the frame. */

import { h, setText } from '../dom/h';
import { clock as clockText, timeOfDay } from '../model/format';
import type { Room } from '../model/room';
import { State, nameOf } from '../protocol/types';

export interface ClockText {
  time: string;
  label: string;
}

/** Shows the time in this element; `take` says it of takes. */
export function clock(element: HTMLElement, room: Room, take: () => ClockText | null): () => void {
  const time = h('p', { class: 'time' });
  const label = h('p', { class: 'label' });
  element.append(time, label);
  return () => {
    const text = take() ?? liveText(room);
    element.hidden = text === null;
    setText(time, text?.time ?? '');
    setText(label, text?.label ?? '');
  };
}

/** Of the performer who is followed, else of the first who is live and has a timecode, else who has any time. */
function liveText(room: Room): ClockText | null {
  const records = room.subjects.flatMap((subject) => room.records.get(subject.id) ?? []);
  const followed = records.find((record) => record.id === room.followed);
  const live = records.filter((record) => record.state === State.Live);
  const record = followed ?? live.find(({ id }) => Number.isFinite(room.timecode(id))) ?? live[0] ?? records[0];
  if (!record) return null;
  const subject = room.subject(record.id);
  const whose = subject && room.subjects.length > 1 ? ` of ${nameOf(subject)}` : '';
  const sample = `sample ${record.sample.toLocaleString('en')}`;
  const timecode = room.timecode(record.id);
  if (Number.isFinite(timecode)) return { time: timeOfDay(timecode), label: `Timecode${whose}, UTC, ${sample}` };
  return { time: clockText(record.time, 2), label: `Source clock${whose}, ${sample}` };
}
