/** What the server had to say. */

import { h } from '../dom/h';
import type { Room } from '../model/room';
import type { Part } from './performers';

export function notices(room: Room): Part {
  const list = h('ol', { class: 'notices' });
  const element = h('section', { class: 'block', hidden: true }, h('h2', {}, 'Notices'), list);
  let shown = '';
  const refresh = (): void => {
    const newest = room.notices[0];
    const now = newest ? `${room.notices.length} ${newest.at} ${newest.times}` : '';
    if (now === shown) return;
    shown = now;
    element.hidden = room.notices.length === 0;
    list.replaceChildren(
      ...room.notices.slice(0, SHOWN).map(({ at, text, times }) => {
        const time = h('time', {}, new Date(at).toLocaleTimeString('en-GB'));
        return h('li', {}, time, h('span', {}, times > 1 ? `${text} (${times} times)` : text));
      }),
    );
  };
  return { element, refresh };
}

const SHOWN = 8;
