/** The bar under the stage that plays takes. */

import { h, setAttribute, setText } from '../dom/h';
import { type Icon, icon, setIcon } from '../dom/icons';
import { clock } from '../model/format';
import type { Player } from './player';
import { SPEEDS } from './playhead';
import { scrubber } from './scrubber';

export interface Transport {
  refresh(): void;
  redraw(): void;
}

/** Fills this element with the controls of a player. */
export function transport(element: HTMLElement, player: Player): Transport {
  const { playhead } = player;
  const play = button('play', 'Play', 'space', () => playhead.toggle());
  const frame = frameField(player);
  const speed = speedChoice(player);
  const range = rangeButtons(player);
  const time = h('span', { class: 'time' });
  const line = scrubber(player.takes, player.span, playhead, (seconds) => player.seek(seconds));
  const buttons = h(
    'div',
    { class: 'group', role: 'group', 'aria-label': 'Play' },
    button('first', 'First frame', 'home', () => player.goTo(0)),
    button('back', 'One frame back', '←', () => player.step(-1)),
    play,
    button('next', 'One frame on', '→', () => player.step(1)),
    button('last', 'Last frame', 'end', () => player.goTo(Infinity)),
  );
  element.append(
    h(
      'div',
      { class: 'controls' },
      buttons,
      frame.element,
      time,
      h('span', { class: 'space' }),
      range.element,
      speed.element,
    ),
    line.element,
  );
  element.hidden = false;

  const refresh = (): void => {
    setIcon(play, playhead.playing ? 'pause' : 'play');
    const label = playhead.playing ? 'Pause' : 'Play';
    setAttribute(play, 'aria-label', label);
    setAttribute(play, 'title', `${label} (space)`);
    const length = player.span.to - player.span.from;
    setText(time, `${clock(playhead.position - player.span.from)} / ${clock(length)}`);
    frame.refresh();
    speed.refresh();
    range.refresh();
    line.refresh();
  };
  return { refresh, redraw: line.redraw };
}

interface Control {
  element: HTMLElement;
  refresh(): void;
}

/** The number of the frame: typed, it goes exactly there. */
function frameField(player: Player): Control {
  const last = Math.max((player.leading?.frames ?? 1) - 1, 0);
  const input = h('input', {
    type: 'number',
    id: 'frame',
    min: '0',
    max: String(last),
    step: '1',
    inputmode: 'numeric',
  });
  const go = (): void => {
    if (input.value !== '') player.goTo(Number(input.value));
  };
  input.onchange = go;
  input.onkeydown = (event) => {
    if (event.key === 'Enter') go();
    if (event.key === 'Escape') input.blur();
  };
  const element = h(
    'span',
    { class: 'frame' },
    h('label', { for: 'frame' }, 'Frame'),
    input,
    h('span', { class: 'of' }, `of ${last.toLocaleString('en')}`),
  );
  input.style.width = `${String(last).length + 3}ch`;
  const refresh = (): void => {
    const now = String(player.frame());
    if (document.activeElement !== input && input.value !== now) input.value = now;
  };
  return { element, refresh };
}

function speedChoice(player: Player): Control {
  const options = SPEEDS.map((speed) => h('option', { value: String(speed) }, `${speed}×`));
  const select = h('select', { id: 'speed', 'aria-label': 'Speed', title: 'Speed (- and +)' }, ...options);
  select.onchange = () => (player.playhead.speed = Number(select.value));
  const refresh = (): void => {
    const now = String(player.playhead.speed);
    if (select.value !== now) select.value = now;
  };
  return { element: h('span', { class: 'speed' }, select), refresh };
}

function rangeButtons(player: Player): Control {
  const { playhead } = player;
  const from = h(
    'button',
    { type: 'button', title: 'The range begins here (i)', onclick: () => playhead.mark('from') },
    'In',
  );
  const to = h(
    'button',
    { type: 'button', title: 'The range ends here (o)', onclick: () => playhead.mark('to') },
    'Out',
  );
  const clear = button('remove', 'No range', 'u', () => playhead.clearRange());
  const repeat = button('loop', 'Repeat', 'r', () => (playhead.repeat = !playhead.repeat));
  const refresh = (): void => {
    clear.disabled = playhead.range === null;
    setAttribute(repeat, 'aria-pressed', String(playhead.repeat));
  };
  const element = h(
    'div',
    { class: 'group range-buttons', role: 'group', 'aria-label': 'Range' },
    from,
    to,
    clear,
    repeat,
  );
  return { element, refresh };
}

function button(name: Icon, label: string, key: string, onclick: () => void): HTMLButtonElement {
  return h(
    'button',
    { type: 'button', class: 'icon', 'aria-label': label, title: `${label} (${key})`, onclick },
    icon(name),
  );
}
