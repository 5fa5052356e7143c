/** The channels that are plotted, and their samples: rolling while live, whole of a take. */

import { bytes } from '../protocol/api';
import { type Series, decodeSeries } from '../protocol/decode';
import type { PlotRequest } from '../protocol/live';
import type { Take } from '../protocol/types';
import { frameTime } from '../transport/timeline';
import { type Channel, channelKey } from './channels';
import { Rolling } from './rolling';
import type { Column } from './table';

/** Seconds of a live channel that are kept: what can be looked at after pausing. */
export const WINDOW = 10;

export interface Trace {
  /** The number under which the server sends it. */
  id: number;
  key: string;
  channel: Channel;
  /** The place of its colour in the palette. */
  color: number;
  column(): Column;
}

export class Traces {
  readonly all: Trace[] = [];
  private readonly rolling = new Map<number, Rolling>();
  private next = 1;

  constructor(
    /** Asks the server for these live channels. */
    private readonly ask: (channels: PlotRequest[]) => void,
    private readonly takeOf: (subject: number) => Take | undefined,
    /** Samples came, or channels did. */
    private readonly changed: () => void,
    private readonly failed: (text: string) => void,
  ) {}

  keys(): Set<string> {
    return new Set(this.all.map((trace) => trace.key));
  }

  /** Adds a channel or removes it. */
  toggle(channel: Channel): void {
    const key = channelKey(channel);
    if (this.keys().has(key)) this.remove(key);
    else this.add(channel, key);
  }

  remove(key: string): void {
    const place = this.all.findIndex((trace) => trace.key === key);
    const [gone] = place < 0 ? [] : this.all.splice(place, 1);
    if (!gone) return;
    this.rolling.delete(gone.id);
    this.told();
  }

  /** Samples of a live channel, with the seconds that lie between its source's clock and the page's. */
  take(series: Series, shift: (subject: number) => number): void {
    const trace = this.all.find((each) => each.id === series.channel);
    const rolling = this.rolling.get(series.channel);
    if (!trace || !rolling) return;
    const by = shift(trace.channel.subject);
    rolling.push(
      series.time.map((time) => time + by),
      series.value,
    );
    this.changed();
  }

  private add(channel: Channel, key: string): void {
    if (this.all.length >= MOST) return this.failed(`${MOST} channels are the most that can be plotted at once`);
    const id = this.next++;
    const used = new Set(this.all.map((trace) => trace.color));
    const color = Array.from({ length: MOST }, (_, place) => place).find((place) => !used.has(place)) ?? 0;
    const take = this.takeOf(channel.subject);
    this.all.push({ id, key, channel, color, column: take ? this.whole(channel, take) : this.live(id) });
    this.told();
  }

  private live(id: number): () => Column {
    const rolling = new Rolling(WINDOW);
    this.rolling.set(id, rolling);
    return () => ({ time: rolling.times().slice(), value: rolling.values().slice() });
  }

  private whole(channel: Channel, take: Take): () => Column {
    let column: Column = { time: new Float64Array(), value: new Float32Array() };
    bytes(`/api/takes/${take.id}/series?channel=${encodeURIComponent(channel.name)}`).then(
      (buffer) => {
        const { value } = decodeSeries(buffer);
        // By the frames' own times, so that the playhead stands exactly on its sample.
        column = { time: Float64Array.from(value, (_, frame) => frameTime(take, frame)), value };
        this.changed();
      },
      (error: Error) => this.failed(error.message),
    );
    return () => column;
  }

  private told(): void {
    const live = this.all.filter((trace) => this.rolling.has(trace.id));
    this.ask(live.map(({ id, channel }) => ({ id, subject: channel.subject, channel: channel.name })));
    this.changed();
  }
}

const MOST = 16;
