/** Frames of a take, fetched in blocks around the playhead and kept until others need the room. */

import { decodeRecords } from './decode';
import { bytes } from './api';
import type { SubjectRecord, Take } from './types';

export type Fetch = (path: string) => Promise<ArrayBuffer>;

export class TakeFrames {
  /** In the order of last use, oldest first: a Map keeps the order of insertion. */
  private readonly blocks = new Map<number, SubjectRecord[] | Promise<void>>();

  constructor(
    readonly take: Take,
    /** Called when frames that were asked for have come. */
    private readonly arrived: () => void,
    private readonly fetchBytes: Fetch = bytes,
  ) {}

  /** The frame, or undefined while it is on its way. Asks for it, and for those that will be played next. */
  frame(number: number, direction: 1 | -1 = 1): SubjectRecord | undefined {
    if (number < 0 || number >= this.take.frames) return undefined;
    const block = Math.floor(number / BLOCK);
    const held = this.ask(block);
    this.ask(block + direction);
    return Array.isArray(held) ? held[number - block * BLOCK] : undefined;
  }

  private ask(block: number): SubjectRecord[] | Promise<void> | undefined {
    const from = block * BLOCK;
    if (from < 0 || from >= this.take.frames) return undefined;
    const held = this.blocks.get(block) ?? this.load(block, from);
    this.blocks.delete(block);
    this.blocks.set(block, held);
    this.forget();
    return held;
  }

  private async load(block: number, from: number): Promise<void> {
    const count = Math.min(BLOCK, this.take.frames - from);
    try {
      const buffer = await this.fetchBytes(`/api/takes/${this.take.id}/frames?from=${from}&count=${count}`);
      if (this.blocks.has(block)) this.blocks.set(block, decodeRecords(buffer));
    } catch {
      // Forgotten for a moment, so that it is asked for again, but not at each frame that is drawn.
      window.setTimeout(() => this.blocks.delete(block), 500);
      return;
    }
    this.arrived();
  }

  private forget(): void {
    for (const block of this.blocks.keys()) {
      if (this.blocks.size <= KEPT) return;
      this.blocks.delete(block);
    }
  }
}

/** Frames in a block: 167 kB of a body of 23 segments. */
const BLOCK = 240;
/** Blocks that are kept of each take. */
const KEPT = 24;
