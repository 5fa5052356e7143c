import type { Object3D, PerspectiveCamera } from 'three';
import { State, nameOf } from '../protocol/types';
import type { Performer } from './performer';
import type { Look } from './room/theme';
import { Tag, type TagText } from './tag';

/** The name tags of all performers. */
export class Tags {
  private readonly tags = new Map<number, Tag>();
  private shown: Performer[] = [];

  constructor(private readonly parent: Object3D) {}

  /** Writes the tags of these performers, and takes away all others. */
  write(performers: Performer[], look: Look): void {
    this.shown = performers;
    const ids = new Set(performers.map(({ subject }) => subject.id));
    for (const [id, tag] of this.tags) if (!ids.has(id)) this.remove(id, tag);
    for (const performer of performers) this.tag(performer.subject.id).write(text(performer), look);
  }

  /** Puts each over its performer, the nearest above the others. */
  place(camera: PerspectiveCamera, height: number): void {
    for (const performer of this.shown) {
      const tag = this.tags.get(performer.subject.id);
      const top = performer.top();
      if (!tag) continue;
      tag.sprite.visible = top !== null;
      if (top) tag.place(top, camera, height);
    }
  }

  dispose(): void {
    for (const [id, tag] of this.tags) this.remove(id, tag);
  }

  private tag(id: number): Tag {
    const known = this.tags.get(id);
    if (known) return known;
    const tag = new Tag();
    this.tags.set(id, tag);
    this.parent.add(tag.sprite);
    return tag;
  }

  private remove(id: number, tag: Tag): void {
    this.parent.remove(tag.sprite);
    tag.dispose();
    this.tags.delete(id);
  }
}

function text(performer: Performer): TagText {
  const { subject, color, state } = performer;
  return { name: nameOf(subject), note: performer.note(), state: STATES[state], color };
}

const STATES = { [State.Live]: '', [State.Stale]: 'STALE', [State.Lost]: 'LOST', [State.Away]: '' } as const;
