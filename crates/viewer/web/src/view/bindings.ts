/** What each key does. help.ts tells of them. */

import type { App } from '../app';
import type { Keys } from './keys';

export function keysOf(app: App): Keys {
  const { controls } = app;
  return { ...viewKeys(controls), ...takeKeys(app) };
}

function viewKeys(controls: App['controls']): Keys {
  return {
    f: controls.followNext,
    '0': () => controls.preset('free'),
    '1': () => controls.preset('front'),
    '2': () => controls.preset('side'),
    '3': () => controls.preset('top'),
    n: () => controls.toggle('names'),
    a: () => controls.toggle('axes'),
    t: () => controls.toggle('trails'),
    c: () => controls.toggle('com'),
    m: () => controls.toggle('markers'),
    g: controls.togglePlots,
    l: controls.toggleTheme,
    p: () => void controls.screenshot(),
    s: () => void controls.share(),
    '?': controls.help,
  };
}

function takeKeys(app: App): Keys {
  type Player = NonNullable<App['player']>;
  const take = (action: (player: Player) => void) => () => {
    if (app.player) action(app.player);
  };
  const jump = (seconds: number) => take((player) => player.seek(player.playhead.position + seconds));
  return {
    Space: take((player) => player.playhead.toggle()),
    ArrowLeft: take((player) => player.step(-1)),
    ArrowRight: take((player) => player.step(1)),
    'Shift+ArrowLeft': take((player) => player.step(-10)),
    'Shift+ArrowRight': take((player) => player.step(10)),
    PageUp: jump(-1),
    PageDown: jump(1),
    Home: take((player) => player.goTo(0)),
    End: take((player) => player.goTo(Infinity)),
    '-': take((player) => player.playhead.changeSpeed(-1)),
    '+': take((player) => player.playhead.changeSpeed(1)),
    '=': take((player) => player.playhead.changeSpeed(1)),
    i: take((player) => player.playhead.mark('from')),
    o: take((player) => player.playhead.mark('to')),
    u: take((player) => player.playhead.clearRange()),
    r: take((player) => (player.playhead.repeat = !player.playhead.repeat)),
  };
}
