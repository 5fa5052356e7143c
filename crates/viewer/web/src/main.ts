/** The page: puts its parts together, and keeps them at what is known now. */

import 'uplot/dist/uPlot.min.css';
import './style/index.css';
import { App } from './app';
import { byId, h } from './dom/h';

try {
  // What tests and the console of the browser look at.
  Object.assign(window, { posewire: new App() });
} catch (error) {
  const empty = byId('empty');
  empty.hidden = false;
  const help = 'It needs WebGL 2: another browser has it, or hardware acceleration has to be switched on in this one.';
  empty.replaceChildren(
    h('div', { class: 'waiting' }, h('h2', {}, 'This browser cannot draw the stage'), h('p', {}, help)),
  );
  throw error;
}
