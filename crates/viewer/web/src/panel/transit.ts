/** How long a character's samples are on their way, and how unevenly, as far as the clocks can tell. */

import { h, setText } from '../dom/h';
import { milliseconds } from '../model/format';
import type { Percentiles, StreamStatistics, Transit } from '../protocol/statistics';

export interface TransitFacts {
  element: HTMLElement;
  show(streams: StreamStatistics[]): void;
}

export function transitFacts(): TransitFacts {
  const latency = h('dd', {});
  const jitter = h('dd', {});
  const worth = h('small', {});
  const element = h(
    'dl',
    { class: 'facts', hidden: true },
    h('div', {}, h('dt', {}, 'Latency', worth), latency),
    h('div', {}, h('dt', {}, 'Jitter', h('small', {}, 'Longer on the way than the quickest of late')), jitter),
  );
  const show = (streams: StreamStatistics[]): void => {
    // The same for each type of a character; NatNet's server tells its own.
    const transit = streams.find((stream) => stream.transit_ms)?.transit_ms;
    element.hidden = !transit;
    if (!transit) return;
    setText(latency, spread(transit.latency));
    setText(jitter, spread(transit.variation));
    setText(worth, WORTH[transit.clocks] ?? transit.clocks);
  };
  return { element, show };
}

/** "3.1 ms, p99 12 ms". */
export function spread(of: Percentiles | null | undefined): string {
  return of ? `${milliseconds(of.p50)}, p99 ${milliseconds(of.p99)}` : 'not known';
}

/** What the latency is worth, by what the clocks of both sides have in common. */
const WORTH: Record<Transit['clocks'], string> = {
  same: 'From the timecode to the arrival, by one clock',
  agree: 'From the timecode to the arrival, as far off as the two clocks are',
  differ: 'The timecode is of another time than here',
  'no-timecode': 'The sender sends no timecode (type 25)',
};
