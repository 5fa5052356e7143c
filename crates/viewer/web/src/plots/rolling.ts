/** The last seconds of a live channel: samples in, arrays out, without growing. */

export class Rolling {
  private time = new Float64Array(FIRST);
  private value = new Float32Array(FIRST);
  private from = 0;
  private to = 0;

  /** Keeps so many seconds. */
  constructor(private readonly seconds: number) {}

  /** Takes samples, oldest first. Time that goes back begins anew: the source was started again. */
  push(time: Float64Array, value: Float32Array): void {
    const first = time[0];
    if (first === undefined) return;
    if (this.to > this.from && first < this.time[this.to - 1]!) this.from = this.to = 0;
    this.makeRoom(time.length);
    this.time.set(time, this.to);
    this.value.set(value, this.to);
    this.to += time.length;
    this.forget(this.time[this.to - 1]! - this.seconds);
  }

  /** Seconds, oldest first. A view: valid until the next push. */
  times(): Float64Array {
    return this.time.subarray(this.from, this.to);
  }

  values(): Float32Array {
    return this.value.subarray(this.from, this.to);
  }

  private forget(before: number): void {
    while (this.from < this.to && this.time[this.from]! < before) this.from++;
  }

  /** Moves what is kept to the beginning when the end is reached, into twice the room when that is not enough. */
  private makeRoom(count: number): void {
    if (this.to + count <= this.time.length) return;
    const kept = this.to - this.from;
    const size = Math.max(this.time.length, 2 ** Math.ceil(Math.log2(2 * (kept + count))));
    const [time, value] = [this.times(), this.values()];
    const [newTime, newValue] = [new Float64Array(size), new Float32Array(size)];
    newTime.set(time);
    newValue.set(value);
    [this.time, this.value, this.from, this.to] = [newTime, newValue, 0, kept];
  }
}

const FIRST = 1024;
