/** Chooses channels: a search over all of them, in a dialog. */

import { h, setAttribute } from '../dom/h';
import { icon } from '../dom/icons';
import type { Subject } from '../protocol/types';
import { type Channel, channelKey, search, suggestions, title, unitName } from './channels';

/** Opens the dialog. `chosen` says which are plotted, `toggle` adds or removes one. */
export function pickChannels(subjects: Subject[], chosen: () => Set<string>, toggle: (channel: Channel) => void): void {
  const input = h('input', {
    type: 'text',
    role: 'searchbox',
    id: 'channel-search',
    placeholder: 'right knee flexion',
    autocomplete: 'off',
    spellcheck: 'false',
  });
  const list = h('ul', { class: 'channels' });
  const note = h('p', { class: 'aside', role: 'status' });
  const dialog = h('dialog', { class: 'picker', 'aria-labelledby': 'picker-title' });
  const close = h(
    'button',
    { type: 'button', class: 'icon', 'aria-label': 'Close', onclick: () => dialog.close() },
    icon('remove'),
  );
  const label = h('label', { for: 'channel-search' }, 'Search by joint, segment, quantity or axis');
  dialog.append(h('header', {}, h('h2', { id: 'picker-title' }, 'Plot a channel'), close), label, input, list, note);

  const fill = (): void => {
    const text = input.value.trim();
    const channels = text ? search(subjects, text, LIMIT) : firstOffered(subjects);
    list.replaceChildren(...channels.map((channel) => row(channel, subjects.length > 1, chosen, toggle)));
    note.textContent = noteOf(text, channels.length);
  };
  input.oninput = fill;
  input.onkeydown = (event) => {
    const first = list.querySelector('button');
    if (event.key === 'ArrowDown' || event.key === 'Enter') event.preventDefault();
    if (event.key === 'ArrowDown') first?.focus();
    if (event.key === 'Enter') first?.click();
  };
  list.onkeydown = (event) => walk(event, input);
  dialog.onclick = (event) => event.target === dialog && dialog.close();
  dialog.onclose = () => dialog.remove();
  fill();
  document.body.append(dialog);
  dialog.showModal();
  input.focus();
}

function firstOffered(subjects: Subject[]): Channel[] {
  const offered = suggestions(subjects);
  return offered.length > 0 ? offered : search(subjects, '', LIMIT);
}

function noteOf(text: string, found: number): string {
  if (found === 0) return `Nobody has a channel “${text}”.`;
  if (found === LIMIT) return `The first ${LIMIT}: another word narrows them down.`;
  return text ? '' : 'What is asked for most. Type to find all others.';
}

function row(
  channel: Channel,
  many: boolean,
  chosen: () => Set<string>,
  toggle: (channel: Channel) => void,
): HTMLElement {
  const key = channelKey(channel);
  const button = h(
    'button',
    { type: 'button', 'aria-pressed': String(chosen().has(key)) },
    h('span', { class: 'name' }, title(channel)),
    h('span', { class: 'detail' }, [many ? channel.subjectName : '', unitName(channel.unit)].filter(Boolean).join(', ')),
  );
  button.onclick = () => {
    toggle(channel);
    setAttribute(button, 'aria-pressed', String(chosen().has(key)));
    // What was added is seen in the plots; what was taken away may be replaced by another.
    if (chosen().has(key)) button.closest('dialog')?.close();
  };
  return h('li', {}, button);
}

/** Up and down go through the list, and from its top to the search. */
function walk(event: KeyboardEvent, input: HTMLElement): void {
  if (event.key !== 'ArrowDown' && event.key !== 'ArrowUp') return;
  event.preventDefault();
  const item = (event.target as HTMLElement).closest('li');
  const next = event.key === 'ArrowDown' ? item?.nextElementSibling : item?.previousElementSibling;
  if (next) next.querySelector('button')?.focus();
  else if (event.key === 'ArrowUp') input.focus();
}

const LIMIT = 60;
