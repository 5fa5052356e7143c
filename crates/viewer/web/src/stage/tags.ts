import type { Object3D, PerspectiveCamera, Vector3 } from 'three';
import { State, nameOf } from '../protocol/types';
import type { Performer } from './performer';
import type { Look } from './room/theme';
import { type Place, Tag, type TagText } from './tag';

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

  /** Puts each over its performer, in a picture of so many CSS pixels: the nearest first, others above it. */
  place(camera: PerspectiveCamera, width: number, height: number): void {
    const places: Place[] = [];
    for (const { tag, top } of this.nearestFirst(camera)) {
      const wanted = tag.place(top, camera, width, height);
      const free = clear(wanted, places);
      places.push(free);
      tag.lift(wanted.bottom - free.bottom);
    }
  }

  private nearestFirst(camera: PerspectiveCamera): { tag: Tag; top: Vector3; away: number }[] {
    const seen = this.shown.flatMap((performer) => {
      const tag = this.tags.get(performer.subject.id);
      const top = performer.top();
      if (tag) tag.sprite.visible = top !== null;
      return tag && top ? [{ tag, top, away: camera.position.distanceTo(top) }] : [];
    });
    return seen.sort((a, b) => a.away - b.away);
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

/** The place over all others that it would lie on, as far as that is near, and whole in the picture. */
function clear(wanted: Place, others: Place[]): Place {
  let place = wanted;
  for (let tries = 0; tries < TRIES; tries += 1) {
    const other = others.find((each) => overlap(each, place));
    if (!other) break;
    place = moved(place, other.top - 1 - place.bottom);
  }
  return place.top < 2 && wanted.bottom > 0 ? moved(place, 2 - place.top) : place;
}

function overlap(a: Place, b: Place): boolean {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

function moved(place: Place, down: number): Place {
  return { ...place, top: place.top + down, bottom: place.bottom + down };
}

/** How many tags one is put above. */
const TRIES = 4;

function text(performer: Performer): TagText {
  const { subject, color, state } = performer;
  return { name: nameOf(subject), note: performer.note(), state: STATES[state], color };
}

const STATES = { [State.Live]: '', [State.Stale]: 'STALE', [State.Lost]: 'LOST', [State.Away]: '' } as const;
