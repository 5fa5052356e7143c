/** The page's icons: strokes on a grid of 20, in the colour of the text around them. */

import { s } from './h';

const PATHS = {
  follow: 'M10 3v3M10 14v3M3 10h3M14 10h3M10 7a3 3 0 1 1 0 6 3 3 0 0 1 0-6Z',
  shown: 'M2 10s3-5 8-5 8 5 8 5-3 5-8 5-8-5-8-5ZM10 7.8a2.2 2.2 0 1 1 0 4.4 2.2 2.2 0 0 1 0-4.4Z',
  hidden:
    'M3 3l14 14M8 5.3C8.6 5.1 9.3 5 10 5c5 0 8 5 8 5a14 14 0 0 1-2.3 2.8M5 6.5A14 14 0 0 0 2 10s3 5 8 5c1.3 0 2.5-.3 3.5-.8',
  camera: 'M3 6.5h3L7.5 4.5h5L14 6.5h3v9H3ZM10 8.3a2.6 2.6 0 1 1 0 5.2 2.6 2.6 0 0 1 0-5.2Z',
  link: 'M8.5 11.5a3 3 0 0 0 4.2 0l3-3a3 3 0 0 0-4.2-4.2l-1 1M11.5 8.5a3 3 0 0 0-4.2 0l-3 3a3 3 0 0 0 4.2 4.2l1-1',
  theme: 'M10 3.5a6.5 6.5 0 1 0 0 13ZM10 3.5a6.5 6.5 0 0 1 0 13',
  help: 'M7.3 7.5a2.7 2.7 0 1 1 3.7 2.5c-.7.3-1 .8-1 1.5v.5M10 15v.1',
  plots: 'M3 3.5v13h14M5.5 12.5l3-4 2.5 2.5 4.5-6',
  play: 'M6 4l10 6-10 6Z',
  pause: 'M6.5 4v12M13.5 4v12',
  first: 'M5 4v12M16 4.5L8 10l8 5.5Z',
  last: 'M15 4v12M4 4.5L12 10l-8 5.5Z',
  back: 'M13 4.5L6 10l7 5.5Z',
  next: 'M7 4.5L14 10l-7 5.5Z',
  loop: 'M4 9V8a3 3 0 0 1 3-3h8M12.5 2.5L15 5l-2.5 2.5M16 11v1a3 3 0 0 1-3 3H5M7.5 17.5L5 15l2.5-2.5',
  remove: 'M5.5 5.5l9 9M14.5 5.5l-9 9',
  add: 'M10 4v12M4 10h12',
  download: 'M10 3v9M6.5 8.5L10 12l3.5-3.5M4 16.5h12',
  record: 'M10 5a5 5 0 1 1 0 10 5 5 0 0 1 0-10Z',
  stop: 'M5.5 5.5h9v9h-9Z',
  reset: 'M4.5 10a5.5 5.5 0 1 1 1.7 4M4.5 14.5V10.5h4',
} as const;

export type Icon = keyof typeof PATHS;

/** An icon. It says nothing to a screen reader: what it stands in is labelled. */
export function icon(name: Icon): SVGSVGElement {
  return s(
    'svg',
    { viewBox: '0 0 20 20', class: `icon-${name}`, 'aria-hidden': 'true', focusable: 'false' },
    s('path', { d: PATHS[name] }),
  );
}

/** Puts another icon in the place of one. */
export function setIcon(element: Element, name: Icon): void {
  const old = element.querySelector('svg');
  if (old?.classList.contains(`icon-${name}`)) return;
  old?.replaceWith(icon(name));
}
