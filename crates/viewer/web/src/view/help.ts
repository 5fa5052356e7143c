/** The keys, in a dialog. */

import { h } from '../dom/h';
import { icon } from '../dom/icons';

/** Opens the dialog; closing it brings the focus back to where it was. */
export function openHelp(takes: boolean): void {
  const dialog = h('dialog', { class: 'help', 'aria-labelledby': 'help-title' });
  const close = h(
    'button',
    { type: 'button', class: 'icon', 'aria-label': 'Close', onclick: () => dialog.close() },
    icon('remove'),
  );
  const groups = takes ? [...TAKE_KEYS, ...KEYS] : KEYS;
  dialog.append(
    h('header', {}, h('h2', { id: 'help-title' }, 'Keys'), close),
    ...groups.map(([title, keys]) => h('section', {}, h('h3', {}, title), list(keys))),
    h(
      'p',
      { class: 'aside' },
      'Drag to orbit, right-drag or two fingers to move, wheel or pinch to zoom. Click a performer to follow.',
    ),
  );
  dialog.onclick = (event) => event.target === dialog && dialog.close();
  dialog.onclose = () => dialog.remove();
  document.body.append(dialog);
  dialog.showModal();
}

function list(keys: [string[], string][]): HTMLElement {
  const rows = keys.map(([pressed, does]) => {
    const caps = pressed.flatMap((key, place) => [place > 0 ? ' ' : null, h('kbd', {}, key)]);
    return h('div', {}, h('dt', {}, ...caps), h('dd', {}, does));
  });
  return h('dl', {}, ...rows);
}

type Group = [string, [string[], string][]];

const TAKE_KEYS: Group[] = [
  [
    'Take',
    [
      [['Space'], 'Play or pause'],
      [['←', '→'], 'One frame back or on'],
      [['Shift', '←', '→'], 'Ten frames'],
      [['PgUp', 'PgDn'], 'One second back or on'],
      [['Home', 'End'], 'First or last frame'],
      [['-', '+'], 'Slower, faster'],
      [['i', 'o', 'u'], 'Range begins here, ends here, no range'],
      [['r'], 'Repeat'],
    ],
  ],
];

const KEYS: Group[] = [
  [
    'Camera',
    [
      [['f'], 'Follow the next performer, or none'],
      [['1', '2', '3', '0'], 'From the front, the side, above; free'],
    ],
  ],
  [
    'Show',
    [
      [['n'], 'Names'],
      [['a'], 'Local axes'],
      [['t'], 'Trails'],
      [['c'], 'Centre of mass'],
      [['m'], 'Markers'],
      [['g'], 'Plots'],
      [['l'], 'Light or dark'],
    ],
  ],
  [
    'Keep',
    [
      [['p'], 'Picture as PNG'],
      [['s'], 'Copy the address of this view'],
    ],
  ],
  ['Help', [[['?'], 'These keys']]],
];
