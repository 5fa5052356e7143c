/** Who is there: state, rate, colour; whom to follow and whom to hide. */

import { h, setAttribute, setText } from '../dom/h';
import { icon, setIcon } from '../dom/icons';
import { hertz, milliseconds } from '../model/format';
import type { Room } from '../model/room';
import { Flag, State, type Subject, type SubjectRecord, nameOf } from '../protocol/types';

export interface PerformerActions {
  follow(id: number): void;
  hide(id: number): void;
  /** The colour that the stage gives a subject, as CSS has it. */
  color(subject: Subject): string;
}

export interface Part {
  element: HTMLElement;
  /** Shows what is now; called ten times a second at most. */
  refresh(): void;
}

export function performers(room: Room, actions: PerformerActions): Part {
  const list = h('ul', { class: 'performers' });
  const title = h('h2', {}, 'Performers');
  let rows: Row[] = [];
  let shown = -1;
  const refresh = (): void => {
    if (shown !== room.revision) {
      shown = room.revision;
      rows = reuse(rows, room.subjects, actions);
      list.replaceChildren(...rows.map((row) => row.element));
      list.classList.toggle('many', rows.length > 8);
      setText(title, heading(room.subjects));
    }
    for (const row of rows) row.refresh(room);
  };
  return { element: h('section', { class: 'block' }, title, list), refresh };
}

/** Rows of subjects that are as they were stay, so that the focus does. */
function reuse(rows: Row[], subjects: Subject[], actions: PerformerActions): Row[] {
  return subjects.map((subject) => rows.find((row) => row.subject === subject) ?? new Row(subject, actions));
}

function heading(subjects: Subject[]): string {
  const people = subjects.filter((subject) => subject.kind === 'person').length;
  const others = subjects.length - people;
  const words = [people > 0 || others === 0 ? `Performers ${people}` : '', others > 0 ? `Objects ${others}` : ''];
  return words.filter(Boolean).join(', ');
}

class Row {
  readonly element: HTMLLIElement;
  private readonly detail = h('span', { class: 'detail' });
  private readonly state = h('span', { class: 'state' });
  private readonly rate = h('span', { class: 'rate' });
  private readonly age = h('span', { class: 'age', title: 'Since the newest sample arrived' });
  private readonly follow: HTMLButtonElement;
  private readonly hide: HTMLButtonElement;
  private readonly ages = new SmoothAge();

  constructor(
    readonly subject: Subject,
    actions: PerformerActions,
  ) {
    const name = nameOf(subject);
    this.follow = toggle('follow', `Follow ${name}`, () => actions.follow(subject.id));
    this.hide = toggle('shown', `Hide ${name}`, () => actions.hide(subject.id));
    const swatch = h('span', { class: 'swatch', 'aria-hidden': 'true' });
    swatch.style.setProperty('--color', actions.color(subject));
    const who = h('div', { class: 'who' }, h('span', { class: 'name' }, name), this.detail);
    const how = h('div', { class: 'how' }, this.state, h('span', { class: 'numbers' }, this.rate, this.age));
    this.element = h('li', { class: 'performer' }, swatch, who, how, this.follow, this.hide);
  }

  refresh(room: Room): void {
    const { id } = this.subject;
    const record = room.records.get(id);
    const state = stateName(room, record);
    setAttribute(this.element, 'data-state', state);
    setText(this.state, STATES[state]);
    const rate = room.rate(this.subject);
    setText(this.rate, rate === null ? '' : hertz(rate));
    setText(this.age, this.ages.text(record, room));
    setText(this.detail, detail(room, this.subject, record));
    setAttribute(this.follow, 'aria-pressed', String(room.followed === id));
    setAttribute(this.hide, 'aria-pressed', String(room.hidden.has(id)));
    setIcon(this.hide, room.hidden.has(id) ? 'hidden' : 'shown');
  }
}

/** The newest pose's age, averaged: single ticks vary by a sample's period. */
class SmoothAge {
  private value = NaN;

  text(record: SubjectRecord | undefined, room: Room): string {
    if (!record || !room.live || record.state !== State.Live) {
      this.value = NaN;
      return '';
    }
    const now = record.age * 1000;
    this.value = Number.isNaN(this.value) ? now : this.value + (now - this.value) * 0.1;
    return milliseconds(this.value);
  }
}

function toggle(name: 'follow' | 'shown', label: string, onclick: () => void): HTMLButtonElement {
  return h(
    'button',
    { type: 'button', class: 'icon', 'aria-pressed': 'false', 'aria-label': label, title: label, onclick },
    icon(name),
  );
}

type StateName = 'live' | 'stale' | 'lost' | 'take' | 'waiting' | 'unknown';

function stateName(room: Room, record: SubjectRecord | undefined): StateName {
  if (!room.live) return 'take';
  if (room.connection !== 'open') return 'unknown';
  if (!record) return 'waiting';
  return record.state === State.Live ? 'live' : record.state === State.Stale ? 'stale' : 'lost';
}

const STATES: Record<StateName, string> = {
  live: 'LIVE',
  stale: 'STALE',
  lost: 'LOST',
  take: 'TAKE',
  waiting: 'WAITING',
  unknown: 'UNKNOWN',
};

/** "23 segments", and what is missing of a whole pose. Of several takes, which is whose. */
function detail(room: Room, subject: Subject, record: SubjectRecord | undefined): string {
  const file = room.takes.length > 1 ? (room.takeOf(subject.id)?.file ?? '') : '';
  const parts = [file, size(subject, record)];
  const flags = room.flags(subject.id) ?? Flag.Positions | Flag.Orientations;
  if (flags & Flag.InPlace) parts.push('orientations only, in place');
  else if (subject.segments.length > 0 && !(flags & Flag.Orientations)) parts.push('positions only');
  return parts.filter(Boolean).join(', ');
}

function size(subject: Subject, record: SubjectRecord | undefined): string {
  if (subject.kind === 'rigid body') return 'rigid body';
  const segments = subject.segments.length;
  if (segments > 0) return `${segments} ${segments === 1 ? 'segment' : 'segments'}`;
  const markers = (record?.markers.length ?? 0) / 3;
  return markers > 0 ? `${markers} ${markers === 1 ? 'marker' : 'markers'}` : subject.kind;
}
