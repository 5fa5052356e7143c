/** The files that are played: what they hold, and their markers and gaps to go to. */

import { h, setText } from '../dom/h';
import { clock, count, hertz } from '../model/format';
import type { Room } from '../model/room';
import { type Take, nameOf } from '../protocol/types';
import type { Part } from './performers';

/** `go` shows a frame of a take. */
export function takes(room: Room, go: (take: Take, frame: number) => void): Part {
  const body = h('div', { class: 'takes' });
  const below = h('p', { class: 'aside' });
  const element = h('section', { class: 'block', hidden: true }, h('h2', {}, 'Takes'), body, below);
  let shown: Take[] | null = null;
  const refresh = (): void => {
    if (room.takes.length === 0) return;
    setText(below, belowText(room));
    if (shown === room.takes) return;
    shown = room.takes;
    element.hidden = false;
    body.replaceChildren(...shown.map((take) => takeBlock(take, room, go)));
  };
  return { element, refresh };
}

/** "Ada reaches 0.96 m below the floor in this frame.": a recording's floor need not be that of the stage. */
function belowText(room: Room): string {
  const lines = room.subjects.flatMap((subject) => {
    const lowest = (room.records.get(subject.id)?.position ?? new Float32Array()).reduce(
      (least, value, at) => (at % 3 === 2 && value < least ? value : least),
      0,
    );
    return lowest < -BELOW ? [`${nameOf(subject)} reaches ${(-lowest).toFixed(2)} m below the floor in this frame.`] : [];
  });
  return lines.join(' ');
}

function takeBlock(take: Take, room: Room, go: (take: Take, frame: number) => void): HTMLElement {
  const subject = room.subject(take.subject);
  const name = h('span', { class: 'summary-name' }, take.file);
  const whose = subject && room.takes.length > 1 ? `${nameOf(subject)}, ` : '';
  const facts = [
    subject ? fact('Performer', nameOf(subject)) : null,
    fact('Frames', count(take.frames)),
    fact('Rate', hertz(take.rate_hz)),
    fact('Length', clock(take.duration_s, 1)),
  ];
  const block = h(
    'details',
    {},
    h('summary', {}, name, h('span', { class: 'summary-note' }, `${whose}${note(take)}`)),
    h('dl', { class: 'facts' }, ...facts),
    places(
      take,
      'Markers',
      take.markers.map(({ frame, name: text }) => ({ frame, text, detail: `frame ${count(frame)}` })),
      go,
    ),
    places(
      take,
      'Gaps',
      take.gaps.map(([frame, missing]) => gap(frame, missing)),
      go,
    ),
    places(
      take,
      'Lost poses',
      (take.lost_poses ?? []).map(([frame, lost]) => ({ frame, text: poses(lost), detail: `frame ${count(frame)}` })),
      go,
    ),
  );
  block.open = room.takes.length === 1;
  return block;
}

/** "72 of 1,200 missing, 11 poses missing". */
function note(take: Take): string {
  const sum = (all: [number, number][]): number => all.reduce((total, [, samples]) => total + samples, 0);
  const missing = sum(take.gaps);
  const lost = sum(take.lost_poses ?? []);
  const parts = [];
  if (missing > 0) parts.push(`${count(missing)} of ${count(take.frames + missing)} missing`);
  if (lost > 0) parts.push(poses(lost));
  return parts.join(', ') || 'complete';
}

function poses(lost: number): string {
  return lost === 1 ? '1 pose missing' : `${count(lost)} poses missing`;
}

function gap(frame: number, missing: number): Place {
  return {
    frame,
    text: missing === 1 ? '1 sample missing' : `${count(missing)} samples missing`,
    detail: `behind frame ${count(frame)}`,
  };
}

interface Place {
  frame: number;
  text: string;
  detail: string;
}

function places(take: Take, title: string, all: Place[], go: (take: Take, frame: number) => void): HTMLElement | null {
  if (all.length === 0) return null;
  const rows = all.slice(0, SHOWN).map(({ frame, text, detail }) => {
    const onclick = (): void => go(take, frame);
    return h(
      'li',
      {},
      h('button', { type: 'button', onclick }, h('span', {}, text), h('span', { class: 'detail' }, detail)),
    );
  });
  const more = all.length > SHOWN ? h('li', { class: 'aside' }, `and ${count(all.length - SHOWN)} more`) : null;
  return h('div', { class: 'places' }, h('h3', {}, title), h('ul', {}, ...rows, more));
}

function fact(name: string, value: string): HTMLElement {
  return h('div', {}, h('dt', {}, name), h('dd', {}, value));
}

/** Metres below the floor that are no mere error of a suit. */
const BELOW = 0.1;

/** Markers and gaps that are listed of each take. */
const SHOWN = 100;
