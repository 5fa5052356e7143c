/** On a narrow screen the panel is a sheet at the bottom: its handle is pressed or drawn up. */

import { setAttribute, setText } from '../dom/h';
import type { Room } from '../model/room';
import { State } from '../protocol/types';

export function sheet(panel: HTMLElement, handle: HTMLButtonElement, summary: HTMLElement, room: Room): () => void {
  const open = (value: boolean): void => {
    panel.classList.toggle('open', value);
    setAttribute(handle, 'aria-expanded', String(value));
  };
  handle.onclick = () => open(!panel.classList.contains('open'));
  drag(handle, open);
  return () => setText(summary, summaryText(room));
}

/** A drag of more than a finger's width up opens, down closes; the click behind it must not undo that. */
function drag(handle: HTMLButtonElement, open: (value: boolean) => void): void {
  let from: number | null = null;
  let moved = false;
  handle.onpointerdown = (event) => {
    from = event.clientY;
    moved = false;
    handle.setPointerCapture(event.pointerId);
  };
  handle.onpointermove = (event) => {
    if (from === null || Math.abs(event.clientY - from) < 24) return;
    open(event.clientY < from);
    moved = true;
  };
  handle.onpointerup = () => (from = null);
  handle.addEventListener(
    'click',
    (event) => {
      if (moved) event.stopImmediatePropagation();
      moved = false;
    },
    { capture: true },
  );
}

/** "4 performers, 1 stale". */
function summaryText(room: Room): string {
  const total = room.subjects.length;
  const parts = [total === 1 ? '1 performer' : `${total} performers`];
  const states = room.subjects.map((subject) => room.state(subject.id));
  const stale = states.filter((state) => state === State.Stale).length;
  const lost = states.filter((state) => state === State.Lost).length;
  if (stale > 0) parts.push(`${stale} stale`);
  if (lost > 0) parts.push(`${lost} lost`);
  return parts.join(', ');
}
