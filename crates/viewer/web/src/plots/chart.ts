/** One chart: channels of one unit over time, with a cursor, zoom and, of takes, the playhead. */

import uPlot from 'uplot';
import { roundStep } from '../transport/track';
import { niceRange } from './range';
import type { Table } from './table';

export interface ChartLine {
  label: string;
  color: string;
}

export interface ChartOptions {
  unit: string;
  lines: ChartLine[];
  /** A time as it stands under the chart. */
  time: (seconds: number) => string;
  /** The time that labels count from: they stand at round distances from it. */
  origin: () => number;
  /** The pointer is at this time, or has left. */
  hover: (seconds: number | null) => void;
  /** This time was clicked. */
  pick: (seconds: number) => void;
  /** The person at the page chose a stretch of time, or, with null, all of it again. */
  zoom: (span: { min: number; max: number } | null) => void;
}

export class Chart {
  private readonly plot: uPlot;
  private readonly head: HTMLDivElement;

  constructor(
    private readonly parent: HTMLElement,
    private readonly options: ChartOptions,
  ) {
    this.plot = new uPlot(this.settings(), [[], ...options.lines.map(() => [])] as uPlot.AlignedData, parent);
    this.head = document.createElement('div');
    this.head.className = 'chart-head';
    this.head.hidden = true;
    this.plot.over.append(this.head);
    this.listen();
  }

  /** Draws these values over this stretch of time. */
  draw(data: Table, min: number, max: number): void {
    this.fit();
    this.plot.batch(() => {
      this.plot.setData(data as uPlot.AlignedData, false);
      this.plot.setScale('x', { min, max });
    });
  }

  /** Moves the line at the playhead; null for none. */
  showHead(seconds: number | null): void {
    const left = seconds === null ? NaN : this.plot.valToPos(seconds, 'x');
    const seen = left >= 0 && left <= this.plot.over.clientWidth;
    this.head.hidden = !seen;
    if (seen) this.head.style.transform = `translateX(${left}px)`;
  }

  dispose(): void {
    this.plot.destroy();
  }

  private fit(): void {
    const { clientWidth: width, clientHeight: height } = this.parent;
    if (width > 0 && height > 0 && (width !== this.plot.width || height !== this.plot.height)) {
      this.plot.setSize({ width, height });
    }
  }

  private settings(): uPlot.Options {
    const style = getComputedStyle(this.parent);
    const color = (name: string): string => style.getPropertyValue(name).trim();
    const grid = { stroke: color('--grid'), width: 1 };
    const axis: uPlot.Axis = { stroke: color('--muted'), grid, ticks: { ...grid, size: 4 }, font: FONT };
    return {
      width: Math.max(this.parent.clientWidth, 100),
      height: Math.max(this.parent.clientHeight, 80),
      padding: [8, 18, 0, 0],
      legend: { show: false },
      cursor: {
        sync: { key: 'posewire', setSeries: false },
        drag: { x: true, y: false, setScale: false, dist: 6 },
        points: { size: 7 },
      },
      scales: { x: { time: false }, y: { range: (_, low, high) => niceRange(low, high) } },
      axes: [
        {
          ...axis,
          size: 26,
          splits: (plot, _axis, min, max) => splits(min, max, this.options.origin(), (plot.width - Y_AXIS) / 70),
          values: (_, times) => times.map(this.options.time),
        },
        { ...axis, size: Y_AXIS, space: 24 },
      ],
      series: [{}, ...this.options.lines.map(series)],
      hooks: {
        setCursor: [(plot) => this.options.hover(cursorTime(plot))],
        setSelect: [(plot) => this.selected(plot)],
      },
    };
  }

  private selected(plot: uPlot): void {
    const { left, width } = plot.select;
    if (width <= 0) return;
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.options.zoom({ min: plot.posToVal(left, 'x'), max: plot.posToVal(left + width, 'x') });
  }

  private listen(): void {
    const { over } = this.plot;
    let pressed = 0;
    over.addEventListener('mousedown', (event) => (pressed = event.clientX));
    over.addEventListener('click', (event) => {
      const time = cursorTime(this.plot);
      if (Math.abs(event.clientX - pressed) < 4 && time !== null) this.options.pick(time);
    });
    // A finger has no hover: drawn sideways it moves the cursor.
    over.addEventListener('pointermove', (event) => {
      if (event.pointerType === 'touch') this.plot.setCursor({ left: event.offsetX, top: event.offsetY });
    });
    over.addEventListener('dblclick', () => this.options.zoom(null));
    over.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
  }

  /** Zooms around the pointer, so that what is under it stays there. */
  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const { min, max } = this.plot.scales['x'] ?? {};
    const at = cursorTime(this.plot);
    if (min == null || max == null || at === null) return;
    const factor = Math.exp(Math.min(Math.max(event.deltaY, -100), 100) * 0.004);
    this.options.zoom({ min: at - (at - min) * factor, max: at + (max - at) * factor });
  }
}

function series({ label, color }: ChartLine): uPlot.Series {
  return { label, stroke: color, width: 1.75, points: { show: false }, spanGaps: false };
}

/** Round times between two, as seen from an origin. */
function splits(min: number, max: number, origin: number, labels: number): number[] {
  const step = roundStep(max - min, labels);
  const first = Math.ceil((min - origin) / step - 1e-6);
  const count = Math.max(Math.floor((max - origin) / step + 1e-6) - first + 1, 0);
  return Array.from({ length: count }, (_, place) => origin + (first + place) * step);
}

function cursorTime(plot: uPlot): number | null {
  const { left } = plot.cursor;
  return left === undefined || left < 0 ? null : plot.posToVal(left, 'x');
}

/** The pixels beside a chart for its values. */
const Y_AXIS = 48;
const FONT = '12px system-ui, sans-serif';
