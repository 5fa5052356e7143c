/** How each stream is doing: per datagram type its rate, what is missing, how evenly it comes; where it was lost. */

import { h, setText } from '../dom/h';
import { count, milliseconds, shortRate } from '../model/format';
import { streamKey } from '../model/history';
import type { Room } from '../model/room';
import type { SourceStatistics, Statistics, StreamStatistics } from '../protocol/statistics';
import { nameOf } from '../protocol/types';
import type { Part } from './performers';
import { lossBlock } from './losses';
import { type Sparkline, sparkline } from './sparkline';
import { transitFacts } from './transit';

export function streams(room: Room): Part {
  const body = h('div', { class: 'streams' });
  const element = h('section', { class: 'block', hidden: true }, h('h2', {}, 'Streams'), body);
  let shown: Statistics | null = null;
  let shape = '';
  let groups: Group[] = [];
  const refresh = (): void => {
    element.hidden = !room.live || !room.statistics?.sources.some((source) => source.subjects.length > 0);
    if (element.hidden || room.statistics === shown || !room.statistics) return;
    shown = room.statistics;
    if (shape !== shapeOf(shown)) {
      shape = shapeOf(shown);
      const open = new Set(groups.filter((group) => group.element.open).map((group) => group.title));
      groups = shown.sources.flatMap((source) => groupsOf(source, room, shown!.sources.length > 1));
      groups.forEach(
        (group, place) => (group.element.open = open.has(group.title) || (open.size === 0 && place === 0)),
      );
      body.replaceChildren(...groups.map((group) => group.element));
    }
    for (const group of groups) group.show(shown, room);
  };
  return { element, refresh };
}

/** What there are rows for: they are made anew when it changes. */
function shapeOf(statistics: Statistics): string {
  return statistics.sources
    .map((source) => source.subjects.map((stream) => `${streamKey(source, stream)}${stream.name}`).join())
    .join('|');
}

/** The streams of one character, or of a server, in a part that folds. */
interface Group {
  title: string;
  element: HTMLDetailsElement;
  show(statistics: Statistics, room: Room): void;
}

function groupsOf(source: SourceStatistics, room: Room, many: boolean): Group[] {
  const names = [...new Set(source.subjects.map(groupKey))];
  const groups = names.map((key) =>
    streamGroup(source, key, many ? `${room.scene?.source[source.source] ?? ''}: ` : '', room),
  );
  return [...groups, lossBlock(source, many ? (room.scene?.source[source.source] ?? '') : '')];
}

function groupKey(stream: StreamStatistics): string {
  return `${stream.character ?? '-'} ${stream.name}`;
}

/** As the stage names the only performer of a source without a name; of several, which is which is told by the number. */
function nameless(room: Room, source: SourceStatistics, stream: StreamStatistics): string {
  const subjects = room.subjects.filter((subject) => subject.source === source.source && !subject.name);
  return subjects.length === 1 ? nameOf(subjects[0]!) : `Character ${stream.character ?? 0}`;
}

function streamGroup(source: SourceStatistics, key: string, prefix: string, room: Room): Group {
  const own = source.subjects.filter((stream) => groupKey(stream) === key).sort((a, b) => a.type.localeCompare(b.type));
  const first = own[0]!;
  const title = `${prefix}${first.name || nameless(room, source, first)}`;
  const rows = own.map((stream) => new StreamRow(streamKey(source, stream), stream));
  const summary = h('span', { class: 'summary-note' });
  const columns = ['Type', 'Rate', 'Last 2 min', 'Missing', INTERVAL];
  const head = h(
    'tr',
    {},
    ...columns.map((column) =>
      h('th', { scope: 'col', title: column === INTERVAL ? 'Time between a datagram and the next' : null }, column),
    ),
  );
  const table = h('table', {}, h('thead', {}, head), h('tbody', {}, ...rows.map((row) => row.element)));
  const transit = transitFacts();
  const heading = h('summary', {}, h('span', { class: 'summary-name' }, title), summary);
  const element = h('details', {}, heading, table, transit.element);
  const show = (statistics: Statistics, room: Room): void => {
    const now = statistics.sources.find((each) => each.source === source.source);
    const streams = now?.subjects.filter((stream) => groupKey(stream) === key) ?? [];
    setText(summary, summaryOf(streams));
    transit.show(streams);
    for (const row of rows) {
      const stream = streams.find((each) => each.type === row.type);
      if (stream) row.show(stream, room);
    }
  };
  return { title, element, show };
}

/** "5 types, 2 missing". */
function summaryOf(streams: StreamStatistics[]): string {
  const missing = streams.reduce((sum, stream) => sum + stream.missing, 0);
  const types = streams.length === 1 ? '1 type' : `${streams.length} types`;
  return missing > 0 ? `${types}, ${count(missing)} missing` : `${types}, none missing`;
}

class StreamRow {
  readonly type: string;
  readonly element: HTMLTableRowElement;
  private readonly rate = h('td', { class: 'number' });
  private readonly missing = h('td', { class: 'number' });
  private readonly interval = h('td', { class: 'number' });
  private readonly line: Sparkline = sparkline();

  constructor(
    private readonly key: string,
    stream: StreamStatistics,
  ) {
    this.type = stream.type;
    this.element = h(
      'tr',
      {},
      h('th', { scope: 'row' }, typeName(stream.type)),
      this.rate,
      h('td', { class: 'spark' }, this.line.element),
      this.missing,
      this.interval,
    );
  }

  show(stream: StreamStatistics, room: Room): void {
    setText(this.rate, shortRate(stream.rate_hz));
    setText(this.missing, count(stream.missing));
    this.missing.classList.toggle('bad', stream.missing > 0);
    const { p50, p99 } = stream.interval_ms ?? { p50: null, p99: null };
    setText(this.interval, `${bare(p50)}, ${bare(p99)}`);
    this.line.show(room.history.seconds(this.key));
    this.element.title = explanation(stream);
  }
}

/** Milliseconds, whose unit is in the head of the column. */
function bare(value: number | null): string {
  return milliseconds(value).replace(' ms', '');
}

/** What has no column: said on hovering over the row. */
function explanation(stream: StreamStatistics): string {
  const { received, duplicate, late, reset, malformed, incomplete } = stream;
  const counts = Object.entries({ received, duplicate, late, reset, malformed, incomplete });
  const said = counts.filter(([name, value]) => name === 'received' || value > 0);
  const quirks = Object.entries(stream.quirks ?? {}).map(([name, times]) => `${name} (${count(times)})`);
  const lines = [said.map(([name, value]) => `${count(value)} ${name}`).join(', ')];
  if (quirks.length > 0) lines.push(`accepted deviations: ${quirks.join(', ')}`);
  return lines.join('\n');
}

function typeName(type: string): string {
  const name = TYPES[type];
  return name ? `${type} ${name}` : type === 'frame' ? 'Frames' : type;
}

const INTERVAL = 'p50, p99 ms';

/** The datagram types of MXTP, in two words at most. */
const TYPES: Record<string, string> = {
  '01': 'Euler',
  '02': 'Quaternion',
  '03': 'Points',
  '04': 'Tags',
  '05': 'Unity',
  '12': 'Meta data',
  '13': 'Scale',
  '20': 'Joint angles',
  '21': 'Linear',
  '22': 'Angular',
  '23': 'Trackers',
  '24': 'Centre of mass',
  '25': 'Timecode',
};
