/** The JSON of the server about streams and recordings. Their fields are those of docs/json.md. */

import type { Scene } from './types';

export interface Percentiles {
  p50: number;
  p99: number;
  max: number;
}

/** How long the samples of a character are on their way, milliseconds. */
export interface Transit {
  variation: Percentiles | null;
  latency: Percentiles | null;
  clocks: 'same' | 'agree' | 'differ' | 'no-timecode';
}

/** One datagram type of one character, or the frames of a NatNet server. */
export interface StreamStatistics {
  character?: number | null;
  name: string;
  type: string;
  rate_hz: number;
  received: number;
  missing: number;
  duplicate: number;
  late: number;
  reset: number;
  malformed: number;
  incomplete: number;
  kernel_dropped?: number;
  samples?: { done: number; partial: number; gone: number } | null;
  transit_ms?: Transit | null;
  datagrams: number;
  quirks: Record<string, number>;
  interval_ms: Percentiles | null;
}

/** What belongs to no character. */
export interface ReceiverStatistics {
  datagrams: number;
  bytes: number;
  malformed: number;
  last_malformed: string | null;
  kernel_dropped: number;
  skipped_bytes: number;
  characters_refused: number;
}

/** A NatNet server. */
export interface ServerStatistics {
  name: string;
  app_version: string;
  address: string;
  connected: boolean;
  latency_ms: { [stage: string]: Percentiles | null } | null;
}

export interface SourceStatistics {
  source: number;
  receiver: ReceiverStatistics | null;
  subjects: StreamStatistics[];
  server: ServerStatistics | null;
}

export interface Statistics {
  sources: SourceStatistics[];
  page: { connections: number; skipped: number };
}

export interface Recorder {
  enabled: boolean;
  state: 'idle' | 'recording' | 'failed';
  name: string | null;
  seconds: number;
  bytes: number;
  datagrams: number;
  lost: number;
  error: string | null;
}

/** A finished take in the folder of recordings. */
export interface Recording {
  name: string;
  bytes: number;
  /** Seconds since 1970, or a date as text. */
  modified: number | string;
}

/** A text message of the WebSocket. */
export type TextMessage =
  | ({ type: 'scene' } & Scene)
  | ({ type: 'statistics' } & Statistics)
  | ({ type: 'recorder' } & Recorder)
  | { type: 'notice'; text: string }
  | { type: 'ended' };
