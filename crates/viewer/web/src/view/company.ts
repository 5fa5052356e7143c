/** Whom the camera goes along with while nobody has chosen: one who is alone, who would walk out of the picture. */

import type { Room } from '../model/room';
import type { Stage } from '../stage';

export class Company {
  private chosen = false;
  private alone: number | null = null;
  private seen = 0;

  constructor(
    private readonly room: Room,
    private readonly stage: Stage,
  ) {}

  /** Somebody chose a view: from now on it is theirs. */
  leave(): void {
    this.chosen = true;
  }

  /** Looks who is there; called ten times a second. */
  refresh(): void {
    if (this.chosen) return;
    const { subjects, records } = this.room;
    const [only] = subjects.length === 1 ? subjects : [];
    if (only && records.has(only.id)) this.join(only.id);
    else if (this.alone !== null && subjects.length > 1) this.part();
  }

  /** The stage needs a moment to have the whole of them in the picture first. */
  private join(id: number): void {
    this.seen++;
    if (this.alone === id || this.seen < 5) return;
    this.alone = id;
    this.follow(id);
  }

  private part(): void {
    this.alone = null;
    this.seen = 0;
    this.follow(null);
    this.stage.preset('free');
  }

  private follow(id: number | null): void {
    this.room.followed = id;
    this.room.revision++;
    this.stage.follow(id);
  }
}
