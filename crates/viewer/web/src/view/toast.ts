/** A line that says what was done, and goes by itself. */

import { byId } from '../dom/h';

let timer = 0;

export function toast(text: string): void {
  const element = byId('toast');
  element.textContent = text;
  element.classList.add('shown');
  window.clearTimeout(timer);
  timer = window.setTimeout(() => element.classList.remove('shown'), 1500 + 45 * text.length);
}
