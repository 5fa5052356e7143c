/** What to do while nobody is seen: where the server listens, what the sender has to be told, why nobody is let in. */

import { h } from '../dom/h';
import type { Room } from '../model/room';

/** Fills this element while there is nobody. */
export function empty(element: HTMLElement, room: Room): () => void {
  let shown: unknown = null;
  return () => {
    const nobody = room.refusal !== null || (room.scene !== null && room.subjects.length === 0);
    element.hidden = !nobody;
    const now = room.refusal ?? room.scene;
    if (!nobody || shown === now) return;
    shown = now;
    element.replaceChildren(content(room));
  };
}

function content(room: Room): HTMLElement {
  if (room.refusal !== null) return words('The server does not let this page in', room.refusal);
  if (room.live) return waiting(room.scene?.source ?? []);
  return words('Nobody is in these files', room.takes.map((take) => take.file).join(', '));
}

function words(title: string, text: string): HTMLElement {
  return h('div', { class: 'waiting' }, h('h2', {}, title), h('p', {}, text));
}

function waiting(sources: string[]): HTMLElement {
  const where = sources.map((source) => h('li', {}, h('code', {}, source)));
  const natnet = sources.some((source) => source.startsWith('natnet'));
  const mxtp = sources.find((source) => source.startsWith('mxtp'));
  return h(
    'div',
    { class: 'waiting' },
    h('h2', {}, 'Waiting for the first performer'),
    h('p', {}, 'This page listens on'),
    h('ul', { class: 'sources' }, ...where),
    mxtp ? mvn(mxtp) : null,
    sources.some(isLoopback)
      ? h(
          'p',
          { class: 'aside' },
          'Only programs of this machine reach a loopback address: 0.0.0.0 listens to others as well.',
        )
      : null,
    natnet ? motive() : null,
    h('p', { class: 'aside' }, 'Without a suit: ', h('code', {}, 'posewire demo')),
  );
}

function mvn(source: string): HTMLElement {
  const port = /:(\d+)/.exec(source.replace(/^[^:]+:\/\//, ''))?.[1] ?? '9763';
  const protocol = source.startsWith('mxtp+tcp') ? 'TCP' : 'UDP';
  return h(
    'ol',
    {},
    h('li', {}, 'In MVN, open Options > Preferences > Miscellaneous > Network Streamer.'),
    h('li', {}, 'Add ', h('b', {}, hostHint()), ', port ', h('b', {}, port), `, ${protocol}.`),
    h(
      'li',
      {},
      'Tick Position + Orientation (Quaternion); Joint Angles, Center of Mass and Time Code as well if you want them here.',
    ),
    h('li', {}, 'Switch the streamer on. Whoever is streamed appears at once.'),
  );
}

function motive(): HTMLElement {
  return h(
    'ol',
    {},
    h('li', {}, 'In Motive, open Edit > Settings > Streaming and switch NatNet on.'),
    h(
      'li',
      {},
      'Choose as local interface the network that both machines are on, and stream skeletons and rigid bodies.',
    ),
  );
}

/** Whether only this machine can send there. */
function isLoopback(source: string): boolean {
  return /^mxtp[^:]*:\/\/(127\.|localhost|\[::1\])/.test(source);
}

/** The name under which the browser found this machine is one that the sender may find it by, unless it is the loopback. */
function hostHint(): string {
  const host = location.hostname;
  const loopback = host === 'localhost' || host.startsWith('127.') || host === '[::1]';
  return loopback ? 'the address of the machine that runs posewire' : `host ${host}`;
}
