/** A picture of the stage, as a file. */

import { h } from '../dom/h';

/** Saves the picture under a name that tells when it was taken. */
export function savePicture(picture: Blob, now = new Date()): string {
  const stamp = now.toISOString().slice(0, 19).replaceAll(':', '-').replace('T', '_');
  const name = `posewire_${stamp}.png`;
  const href = URL.createObjectURL(picture);
  const link = h('a', { href, download: name });
  link.click();
  // The browser has taken it by then; an address that is never given back keeps the picture in memory.
  window.setTimeout(() => URL.revokeObjectURL(href), 10_000);
  return name;
}
