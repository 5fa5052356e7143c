/** A line that says what was done, and goes by itself, or when what it says is past. */

import { byId } from '../dom/h';

let timer = 0;

/** Shows a text; null takes away what is shown. */
export function toast(text: string | null): void {
  const element = byId('toast');
  window.clearTimeout(timer);
  element.classList.toggle('shown', text !== null);
  if (text === null) return;
  element.textContent = text;
  timer = window.setTimeout(() => element.classList.remove('shown'), 1500 + 45 * text.length);
}
