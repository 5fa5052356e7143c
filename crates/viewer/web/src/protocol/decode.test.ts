import { describe, expect, it } from 'vitest';
import { MalformedMessage, decodeMessage, decodeRecords, decodeSeries } from './decode';

describe('records', () => {
  it('are read as they were written', () => {
    const [first, second] = decodeRecords(join(record(7, 2, 1), record(8, 0, 0)));
    expect(first).toMatchObject({ id: 7, sample: 1207, contacts: 5, time: 12.5, age: 0.25, state: 1, flags: 19 });
    expect([...first!.position]).toEqual([0, 1, 2, 3, 4, 5]);
    expect([...first!.orientation]).toEqual([6, 7, 8, 9, 10, 11, 12, 13]);
    expect([...first!.centerOfMass]).toEqual([14, 15, 16]);
    expect([...first!.markers]).toEqual([17, 18, 19]);
    expect(first!.timecode).toBe(86_399.999);
    expect(second).toMatchObject({ id: 8, sample: 1208, timecode: NaN });
    expect(second!.position).toHaveLength(0);
  });

  it('that are cut or lie about their length are refused', () => {
    const whole = record(1, 3, 2);
    for (let length = 1; length < whole.byteLength; length++) {
      expect(() => decodeRecords(whole.slice(0, length))).toThrow(MalformedMessage);
    }
    new DataView(whole).setUint16(34, 2, true);
    expect(() => decodeRecords(whole)).toThrow('a record of');
  });
});

describe('a tick', () => {
  it('has the number of records that it tells', () => {
    const message = join(head(2), record(0, 1, 0), record(1, 1, 0));
    expect(decodeMessage(message)).toMatchObject({ kind: 'tick', tick: { tick: 99, clock: 3.5 } });
    expect(() => decodeMessage(join(head(3), record(0, 1, 0)))).toThrow('3 subjects expected, 1 found');
  });
});

describe('any bytes', () => {
  it('are read or refused, nothing else', () => {
    let seed = 1;
    const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
    const valid = new Uint8Array(join(head(1), record(0, 2, 1)));
    for (let round = 0; round < 2000; round++) {
      const bytes = round % 2 ? valid.slice() : new Uint8Array(Math.floor(random() * 200));
      if (round % 2) bytes[Math.floor(random() * bytes.length)]! ^= 1 << Math.floor(random() * 8);
      else bytes.forEach((_, place) => (bytes[place] = Math.floor(random() * 256)));
      try {
        decodeMessage(bytes.buffer);
      } catch (error) {
        expect(error).toBeInstanceOf(MalformedMessage);
      }
    }
  });
});

describe('a series', () => {
  it('has a time and a value for each sample', () => {
    const buffer = new ArrayBuffer(8 + 2 * 12);
    const view = new DataView(buffer);
    view.setUint8(0, 2);
    view.setUint8(1, 1);
    view.setUint16(2, 4, true);
    view.setUint32(4, 2, true);
    [0.5, 0.75].forEach((time, place) => view.setFloat64(8 + 8 * place, time, true));
    [30, NaN].forEach((value, place) => view.setFloat32(24 + 4 * place, value, true));
    const series = decodeSeries(buffer);
    expect(series.channel).toBe(4);
    expect([...series.time]).toEqual([0.5, 0.75]);
    expect([...series.value]).toEqual([30, NaN]);
    expect(() => decodeSeries(buffer.slice(0, 31))).toThrow(MalformedMessage);
  });
});

/** The head of a tick that tells of so many subjects. */
function head(subjects: number): ArrayBuffer {
  const view = new DataView(new ArrayBuffer(16));
  view.setUint8(0, 1);
  view.setUint8(1, 1);
  view.setUint16(2, subjects, true);
  view.setUint32(4, 99, true);
  view.setFloat64(8, 3.5, true);
  return view.buffer as ArrayBuffer;
}

/** A record whose numbers count up from 0. */
function record(id: number, segments: number, markers: number): ArrayBuffer {
  const floats = 7 * segments + 3 + 3 * markers;
  const view = new DataView(new ArrayBuffer(40 + 4 * floats));
  [view.byteLength, id, 1200 + id, 5].forEach((value, place) => view.setUint32(4 * place, value, true));
  view.setFloat64(16, 12.5, true);
  view.setFloat32(24, 0.25, true);
  view.setUint32(28, id === 7 ? 86_399_999 : 0xffff_ffff, true);
  view.setUint8(32, 1);
  view.setUint8(33, 19);
  view.setUint16(34, segments, true);
  view.setUint16(36, markers, true);
  for (let place = 0; place < floats; place++) view.setFloat32(40 + 4 * place, place, true);
  return view.buffer as ArrayBuffer;
}

function join(...parts: ArrayBuffer[]): ArrayBuffer {
  const whole = new Uint8Array(parts.reduce((sum, part) => sum + part.byteLength, 0));
  let at = 0;
  for (const part of parts) {
    whole.set(new Uint8Array(part), at);
    at += part.byteLength;
  }
  return whole.buffer;
}
