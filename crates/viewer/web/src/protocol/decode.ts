/**
 * The binary messages of the server: records of subjects and series of channels, little endian.
 *
 * The arrays of a record are views into the message: nothing is copied.
 */

import type { State, SubjectRecord } from './types';

/** One tick: every subject that is newer than in the tick before. */
export interface Tick {
  tick: number;
  /** The server's clock in seconds. */
  clock: number;
  records: SubjectRecord[];
}

/** Values of one channel, oldest first. */
export interface Series {
  /** The number that the page gave the channel. */
  channel: number;
  /** Seconds of the source's clock. */
  time: Float64Array;
  value: Float32Array;
}

/** A message that is not as it should be; the connection that it came from is not to be trusted further. */
export class MalformedMessage extends Error {
  override name = 'MalformedMessage';
}

export type Message = { kind: 'tick'; tick: Tick } | { kind: 'series'; series: Series };

/** Reads a binary message of the WebSocket. */
export function decodeMessage(buffer: ArrayBuffer): Message {
  const view = new DataView(buffer);
  need(view, 0, 8);
  const version = view.getUint8(1);
  if (version !== 1) throw new MalformedMessage(`version 1 expected, ${version} found`);
  switch (view.getUint8(0)) {
    case 1:
      return { kind: 'tick', tick: decodeTick(view) };
    case 2:
      return { kind: 'series', series: decodeSeries(buffer) };
    default:
      throw new MalformedMessage(`kind 1 or 2 expected, ${view.getUint8(0)} found`);
  }
}

/** Reads records that stand one behind the other, from here to the end of the buffer. */
export function decodeRecords(buffer: ArrayBuffer, offset = 0): SubjectRecord[] {
  const view = new DataView(buffer);
  const records: SubjectRecord[] = [];
  for (let at = offset; at < buffer.byteLength;) {
    const [record, length] = decodeRecord(view, at);
    records.push(record);
    at += length;
  }
  return records;
}

/** Reads a series message, of the WebSocket or of a take. */
export function decodeSeries(buffer: ArrayBuffer): Series {
  const view = new DataView(buffer);
  need(view, 0, 8);
  const count = view.getUint32(4, true);
  need(view, 8, count * 12);
  return {
    channel: view.getUint16(2, true),
    time: new Float64Array(buffer, 8, count),
    value: new Float32Array(buffer, 8 + count * 8, count),
  };
}

function decodeTick(view: DataView): Tick {
  need(view, 0, TICK_HEAD);
  const records = decodeRecords(view.buffer as ArrayBuffer, TICK_HEAD);
  const told = view.getUint16(2, true);
  if (told !== records.length) throw new MalformedMessage(`${told} subjects expected, ${records.length} found`);
  return { tick: view.getUint32(4, true), clock: view.getFloat64(8, true), records };
}

function decodeRecord(view: DataView, at: number): [SubjectRecord, number] {
  need(view, at, RECORD_HEAD);
  const length = view.getUint32(at, true);
  const segments = view.getUint16(at + 34, true);
  const markers = view.getUint16(at + 36, true);
  const expected = RECORD_HEAD + 4 * (7 * segments + 3 + 3 * markers);
  if (length !== expected) throw new MalformedMessage(`a record of ${expected} bytes expected, ${length} found`);
  need(view, at, length);

  let place = at + RECORD_HEAD;
  const floats = (count: number): Float32Array => {
    const array = new Float32Array(view.buffer as ArrayBuffer, place, count);
    place += 4 * count;
    return array;
  };
  const record = {
    id: view.getUint32(at + 4, true),
    sample: view.getUint32(at + 8, true),
    contacts: view.getUint32(at + 12, true),
    time: view.getFloat64(at + 16, true),
    age: view.getFloat32(at + 24, true),
    timecode: timecode(view.getUint32(at + 28, true)),
    state: Math.min(view.getUint8(at + 32), 2) as State,
    flags: view.getUint8(at + 33),
    position: floats(3 * segments),
    orientation: floats(4 * segments),
    centerOfMass: floats(3),
    markers: floats(3 * markers),
  };
  return [record, length];
}

/** Milliseconds of the day as seconds, or NaN where there is none. */
function timecode(told: number): number {
  return told === NO_TIMECODE ? NaN : told / 1000;
}

function need(view: DataView, at: number, bytes: number): void {
  const left = view.byteLength - at;
  if (left < bytes) throw new MalformedMessage(`${bytes} bytes expected at ${at}, ${left} found`);
}

const TICK_HEAD = 16;
const RECORD_HEAD = 40;
const NO_TIMECODE = 0xffff_ffff;
