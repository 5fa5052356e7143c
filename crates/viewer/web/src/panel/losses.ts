/** Where the samples of a source were lost: what can be known, and what cannot. */

import { h, setText } from '../dom/h';
import { count } from '../model/format';
import { losses } from '../model/history';
import type { SourceStatistics, Statistics } from '../protocol/statistics';
import { spread } from './transit';

/** A part that folds, like those of the streams above it. */
export function lossBlock(source: SourceStatistics, endpoint: string) {
  const what = source.server ? 'Losses and latency' : 'Losses';
  const title = endpoint ? `${what} of ${endpoint}` : what;
  const note = h('span', { class: 'summary-note' });
  const list = h('dl', { class: 'facts' });
  const facts = new Map<string, HTMLElement>();
  const element = h('details', {}, h('summary', {}, h('span', { class: 'summary-name' }, title), note), list);
  const show = (statistics: Statistics): void => {
    const now = statistics.sources.find((each) => each.source === source.source);
    if (!now) return;
    setText(note, verdict(now));
    for (const { name, value, help } of factsOf(now)) setText(fact(list, facts, name, help), value);
  };
  return { title, element, show };
}

/** Where the most was lost, in a few words. */
function verdict(source: SourceStatistics): string {
  const { kernel, partial, gone, frames } = losses(source);
  const kinds: [number, string][] = [
    [kernel, 'on this machine'],
    [partial, 'behind the sender'],
    [gone + frames, 'somewhere before this machine'],
  ];
  const worst = kinds.reduce((most, each) => (each[0] > most[0] ? each : most));
  return worst[0] > 0 ? `lost ${worst[1]}` : 'nothing lost';
}

interface Fact {
  name: string;
  value: string;
  help: string;
}

function factsOf(source: SourceStatistics): Fact[] {
  const { kernel, partial, gone, frames } = losses(source);
  const natnet = source.subjects.some((stream) => !stream.samples);
  const facts = [
    { name: 'Dropped by this machine', value: count(kernel), help: 'Its kernel dropped datagrams: certain.' },
  ];
  if (natnet) {
    facts.push({
      name: 'Frames missing',
      value: count(frames),
      help: 'Never sent, or lost by the network: nobody can tell.',
    });
  } else {
    facts.push(
      { name: 'Samples incomplete', value: count(partial), help: 'Lost or damaged after the sender had made them.' },
      { name: 'Samples gone', value: count(gone), help: 'Never sent, or lost by the network: nobody can tell.' },
    );
  }
  const malformed = source.receiver?.malformed ?? 0;
  facts.push({
    name: 'Malformed datagrams',
    value: count(malformed),
    help: source.receiver?.last_malformed ?? 'Could not be read.',
  });
  return [...facts, ...latencies(source)];
}

/** Of NatNet, whose server has a clock that can be asked. */
function latencies(source: SourceStatistics): Fact[] {
  const latency = source.server?.latency_ms;
  const stages: [string, string, string][] = [
    ['camera_to_host', 'Exposure to sending', 'From the exposure of the cameras until the server sent the frame.'],
    ['host_to_here', 'Sending to here', 'From the sending to the arrival, as far off as the clocks are.'],
  ];
  return source.server ? stages.map(([stage, name, help]) => ({ name, value: spread(latency?.[stage]), help })) : [];
}

function fact(list: HTMLElement, facts: Map<string, HTMLElement>, name: string, help: string): HTMLElement {
  const held = facts.get(name);
  if (held) return held;
  const value = h('dd', {});
  list.append(h('div', {}, h('dt', {}, name, h('small', {}, help)), value));
  facts.set(name, value);
  return value;
}
