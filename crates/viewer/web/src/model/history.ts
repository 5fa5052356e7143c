/** How the statistics went over the last two minutes: what the sparklines show. */

import type { SourceStatistics, Statistics, StreamStatistics } from '../protocol/statistics';

/** A second of a stream. */
export interface Second {
  rate: number;
  /** Samples that went missing in this second. */
  missing: number;
}

export class StatisticsHistory {
  private readonly streams = new Map<string, { seconds: Second[]; missing: number; touched: number }>();
  private turn = 0;

  /** Takes the statistics of another second. */
  add(statistics: Statistics): void {
    this.turn++;
    for (const source of statistics.sources) {
      for (const stream of source.subjects) this.addStream(streamKey(source, stream), stream);
    }
    for (const [key, { touched }] of this.streams) {
      if (this.turn - touched > LENGTH) this.streams.delete(key);
    }
  }

  /** The seconds of a stream, oldest first; at most 120. */
  seconds(key: string): readonly Second[] {
    return this.streams.get(key)?.seconds ?? [];
  }

  private addStream(key: string, stream: StreamStatistics): void {
    const held = this.streams.get(key) ?? { seconds: [], missing: stream.missing, touched: 0 };
    // What comes late is no longer missing: the count can go down.
    held.seconds.push({ rate: stream.rate_hz, missing: Math.max(stream.missing - held.missing, 0) });
    if (held.seconds.length > LENGTH) held.seconds.shift();
    held.missing = stream.missing;
    held.touched = this.turn;
    this.streams.set(key, held);
  }
}

/** What tells a stream from all others. */
export function streamKey(source: SourceStatistics, stream: StreamStatistics): string {
  return `${source.source}/${stream.character ?? '-'}/${stream.type}`;
}

/** Where samples were lost, as far as anybody can tell; docs/statistics.md says what each means. */
export interface Losses {
  /** Datagrams that this machine's kernel dropped: certain. */
  kernel: number;
  /** Samples that lack a type: lost or damaged behind the sender. */
  partial: number;
  /** Samples of which nothing came: the network lost them, or they were never sent. */
  gone: number;
  /** Frames of NatNet that never came: it has no parts that could tell more. */
  frames: number;
}

export function losses(source: SourceStatistics): Losses {
  const found = { kernel: source.receiver?.kernel_dropped ?? 0, partial: 0, gone: 0, frames: 0 };
  const counted = new Set<string>();
  for (const stream of source.subjects) {
    const who = `${stream.character ?? '-'}`;
    if (!stream.samples) found.frames += stream.missing;
    else if (!counted.has(who)) {
      // The same for each type of a character.
      counted.add(who);
      found.partial += stream.samples.partial;
      found.gone += stream.samples.gone;
    }
  }
  return found;
}

const LENGTH = 120;
