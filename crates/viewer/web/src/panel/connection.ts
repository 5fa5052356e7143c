/** Whether the server is there: said in the bar, and across the page when it is not. */

import { setAttribute, setText } from '../dom/h';
import type { Room } from '../model/room';

export function connection(element: HTMLElement, room: Room): () => void {
  return () => {
    const state = room.connection === 'open' && room.ended ? 'ended' : room.connection;
    setAttribute(element, 'data-state', state);
    setAttribute(document.body, 'data-connection', state);
    setText(element, text(room, state));
  };
}

function text(room: Room, state: string): string {
  switch (state) {
    case 'open':
      return room.live ? 'Connected' : 'Take';
    case 'ended':
      return 'The source has ended';
    case 'connecting':
      if (room.refusal !== null) return 'Not let in';
      return room.scene ? 'Connection lost, trying again' : 'Connecting';
    default: {
      if (room.refusal !== null) return 'Not let in';
      const seconds = Math.ceil((room.retryAt - Date.now()) / 1000);
      return seconds > 0 ? `Connection lost, next try in ${seconds} s` : 'Connection lost, trying again';
    }
  }
}
