/** The plots under the stage: a chart for each unit, its channels above it with their values. */

import { h, setAttribute, setText } from '../dom/h';
import { icon, setIcon } from '../dom/icons';
import { clock } from '../model/format';
import type { Subject } from '../protocol/types';
import type { Span } from '../transport/timeline';
import { channelKey, title, unitName } from './channels';
import { Chart } from './chart';
import { pickChannels } from './picker';
import { thin } from './thin';
import { type Trace, type Traces, WINDOW } from './traces';
import { type Column, table, valueAt } from './table';

export interface PlotSource {
  subjects(): Subject[];
  /** The whole timeline of takes; null while live. */
  span(): Span | null;
  /** Where the playhead is. */
  head(): number | null;
  seek(seconds: number): void;
}

/** What is drawn of one unit. */
interface Group {
  unit: string;
  element: HTMLElement;
  chart: Chart;
  traces: Trace[];
  values: HTMLElement[];
  columns: Column[];
}

export class PlotPanel {
  private groups: Group[] = [];
  private shape = '';
  private zoomed: { min: number; max: number } | null = null;
  private hover: number | null = null;
  private paused = false;
  private dirty = true;
  private readonly charts = h('div', { class: 'charts' });
  private readonly pause: HTMLButtonElement;
  private readonly reset: HTMLButtonElement;

  constructor(
    readonly element: HTMLElement,
    private readonly traces: Traces,
    private readonly source: PlotSource,
    close: () => void,
  ) {
    this.pause = button('pause', 'Pause the plots', () => this.setPaused(!this.paused));
    this.reset = button('reset', 'Show all again', () => this.zoom(null));
    const add = h('button', { type: 'button', onclick: () => this.pick() }, icon('add'), 'Channel');
    const bar = h(
      'div',
      { class: 'plot-bar' },
      h('h2', {}, 'Plots'),
      add,
      h('span', { class: 'space' }),
      this.reset,
      this.pause,
      button('remove', 'Close the plots', close),
    );
    element.append(bar, this.charts);
    new ResizeObserver(() => (this.dirty = true)).observe(this.charts);
  }

  /** Samples or channels have changed. What is paused stays as it is. */
  changed(): void {
    if (!this.paused) this.dirty = true;
  }

  /** The colours have changed: everything is made anew. */
  restyle(): void {
    this.shape = '';
    this.dirty = true;
  }

  /** Draws what has changed; called as often as the page draws plots. */
  refresh(): void {
    if (this.element.hidden) return;
    const live = this.source.span() === null;
    this.pause.hidden = !live;
    this.reset.hidden = this.zoomed === null;
    if (this.shape !== this.shapeNow()) this.build();
    if (this.dirty) this.draw();
    for (const group of this.groups) group.chart.showHead(this.source.head());
    this.showValues();
  }

  /** The samples of a channel as they are drawn, by its key. */
  column(key: string): Column | null {
    return this.traces.all.find((trace) => trace.key === key)?.column() ?? null;
  }

  /** The values that stand beside the channels, as text. */
  shownValues(): Record<string, string> {
    const pairs = this.groups.flatMap((group) =>
      group.traces.map((trace, place) => [trace.key, group.values[place]?.textContent ?? '']),
    );
    return Object.fromEntries(pairs) as Record<string, string>;
  }

  pick(): void {
    const chosen = (): Set<string> => this.traces.keys();
    pickChannels(this.source.subjects(), chosen, (channel) => this.traces.toggle(channel));
  }

  private zoom(span: { min: number; max: number } | null): void {
    this.zoomed = span;
    this.dirty = true;
    // Live, what is looked at closely would roll away.
    if (this.source.span() === null) this.setPaused(span !== null);
  }

  private setPaused(paused: boolean): void {
    this.paused = paused;
    if (!paused) this.zoomed = null;
    this.dirty = true;
    setIcon(this.pause, paused ? 'play' : 'pause');
    setAttribute(this.pause, 'aria-label', paused ? 'Go on with the plots' : 'Pause the plots');
    setAttribute(this.pause, 'aria-pressed', String(paused));
  }

  private shapeNow(): string {
    return this.traces.all.map((trace) => trace.key).join('|') || 'none';
  }

  private build(): void {
    this.shape = this.shapeNow();
    for (const group of this.groups) group.chart.dispose();
    const units = [...new Set(this.traces.all.map((trace) => trace.channel.unit))];
    this.charts.replaceChildren(...(units.length === 0 ? [this.nothing()] : []));
    this.groups = units.map((unit) => this.group(unit));
    this.dirty = true;
  }

  private nothing(): HTMLElement {
    const choose = h('button', { type: 'button', onclick: () => this.pick() }, 'Choose a channel');
    return h(
      'div',
      { class: 'nothing' },
      h('p', {}, 'Plot any joint angle, position, velocity or acceleration.'),
      choose,
    );
  }

  private group(unit: string): Group {
    const traces = this.traces.all.filter((trace) => trace.channel.unit === unit);
    const values = traces.map(() => h('span', { class: 'value' }));
    const chips = traces.map((trace, place) => this.chip(trace, values[place]!));
    const canvas = h('div', { class: 'chart' });
    const element = h('figure', {}, h('figcaption', {}, ...chips), canvas);
    this.charts.append(element);
    const style = getComputedStyle(element);
    const lines = traces.map((trace) => ({ label: trace.key, color: traceColor(style, trace) }));
    const chart = new Chart(canvas, {
      unit,
      lines,
      time: (seconds) => this.timeText(seconds),
      origin: () => this.source.span()?.from ?? this.newest(),
      hover: (seconds) => (this.hover = seconds),
      pick: (seconds) => this.source.seek(seconds),
      zoom: (span) => this.zoom(span),
    });
    return { unit, element, chart, traces, values, columns: [] };
  }

  private chip(trace: Trace, value: HTMLElement): HTMLElement {
    const { channel } = trace;
    const many = this.source.subjects().length > 1;
    const name = many ? `${channel.subjectName} ${title(channel)}` : title(channel);
    const remove = button('remove', `Remove ${name}`, () => this.traces.remove(channelKey(channel)));
    const chip = h(
      'span',
      { class: 'chip' },
      h('span', { class: 'key' }),
      h('span', { class: 'name' }, name),
      value,
      remove,
    );
    chip.style.setProperty('--color', `var(--trace-${trace.color % COLORS})`);
    return chip;
  }

  private draw(): void {
    this.dirty = false;
    for (const group of this.groups) {
      if (!this.paused || group.columns.length === 0) group.columns = group.traces.map((trace) => trace.column());
    }
    const { min, max } = this.zoomed ?? this.window();
    for (const group of this.groups)
      group.chart.draw(table(group.columns.map((column) => thin(column, min, max, BUCKETS))), min, max);
  }

  /** The stretch of time that is seen: of takes everything, live the last seconds. */
  private window(): { min: number; max: number } {
    const span = this.source.span();
    if (span) return { min: span.from, max: Math.max(span.to, span.from + 0.001) };
    const newest = this.newest();
    return { min: newest - WINDOW, max: newest };
  }

  private newest(): number {
    const ends = this.groups.flatMap((group) => group.columns.map((column) => column.time.at(-1) ?? -Infinity));
    const newest = Math.max(...ends);
    return Number.isFinite(newest) ? newest : 0;
  }

  private timeText(seconds: number): string {
    const span = this.source.span();
    const { min, max } = this.zoomed ?? this.window();
    const digits = max - min < 0.5 ? 2 : max - min < 5 ? 1 : 0;
    if (span) return clock(seconds - span.from, digits);
    const ago = seconds - this.newest();
    return Math.abs(ago) < 0.005 ? 'now' : `${ago.toFixed(digits)} s`;
  }

  private showValues(): void {
    for (const group of this.groups) {
      group.columns.forEach((column, place) => {
        const at = this.hover ?? this.source.head() ?? column.time.at(-1) ?? 0;
        setText(group.values[place]!, valueText(valueAt(column, at), group.unit));
      });
    }
  }
}

export function traceColor(style: CSSStyleDeclaration, trace: Trace): string {
  return style.getPropertyValue(`--trace-${trace.color % COLORS}`).trim();
}

function valueText(value: number | null, unit: string): string {
  if (value === null) return '–';
  const digits = Math.abs(value) >= 100 ? 1 : unit === 'deg' ? 2 : 3;
  const name = unitName(unit);
  return `${value.toFixed(digits)}${name && !name.startsWith('°') ? ' ' : ''}${name}`;
}

function button(name: 'pause' | 'reset' | 'remove', label: string, onclick: () => void): HTMLButtonElement {
  return h('button', { type: 'button', class: 'icon', 'aria-label': label, title: label, onclick }, icon(name));
}

const COLORS = 8;
/** Places for a lowest and a highest value over the width of a chart. */
const BUCKETS = 1000;
