/** The view as the part of the address behind #: camera, whom it follows, what is shown, the frame, the plots. */

import type { Vector } from '../protocol/types';

export interface SharedView {
  /** Where the camera is and where it looks, metres, Z up. */
  camera?: { position: Vector; target: Vector };
  follow?: number;
  /** What is shown beside the bodies: of axes, trails, names, com, markers those that are. */
  show?: string[];
  hidden?: number[];
  /** The frame of the first take. */
  frame?: number;
  /** Channels with their subject: "0:position/Pelvis/z". */
  plots?: string[];
}

/** As text behind #. */
export function writeHash(view: SharedView): string {
  const parts: string[] = [];
  const add = (name: string, value: string): number => parts.push(`${name}=${value}`);
  if (view.camera) add('camera', [...view.camera.position, ...view.camera.target].map(short).join(','));
  if (view.follow !== undefined) add('follow', String(view.follow));
  if (view.show) add('show', view.show.join(','));
  if (view.hidden?.length) add('hidden', view.hidden.join(','));
  if (view.frame !== undefined) add('frame', String(view.frame));
  for (const plot of view.plots ?? [])
    add('plot', encodeURIComponent(plot).replaceAll('%2F', '/').replaceAll('%3A', ':'));
  return parts.join('&');
}

/** Reads such a text. Whatever makes no sense is left out: it may have been typed. */
export function readHash(hash: string): SharedView {
  const values = new URLSearchParams(hash.replace(/^#/, '').replaceAll('+', '%2B'));
  const view: SharedView = {};
  const camera = numbers(values.get('camera'));
  if (camera?.length === 6) {
    const [position, target] = [camera.slice(0, 3) as Vector, camera.slice(3) as Vector];
    const away = Math.hypot(...position.map((value, axis) => value - target[axis]!));
    if (away >= NEAREST && camera.every((value) => Math.abs(value) <= FARTHEST)) view.camera = { position, target };
  }
  const [follow] = numbers(values.get('follow')) ?? [];
  if (follow !== undefined) view.follow = follow;
  const show = values.get('show');
  if (show !== null) view.show = show.split(',').filter(Boolean);
  const hidden = numbers(values.get('hidden'));
  if (hidden) view.hidden = hidden;
  const [frame] = numbers(values.get('frame')) ?? [];
  if (frame !== undefined && frame >= 0) view.frame = Math.round(frame);
  const plots = values.getAll('plot');
  if (plots.length > 0) view.plots = plots;
  return view;
}

/** Metres from what it looks at that a camera may be: nearer, it looks nowhere. */
const NEAREST = 0.1;
/** Metres from the origin that a camera may be: beyond, nothing is seen and nobody finds back. */
const FARTHEST = 1000;

function numbers(text: string | null): number[] | null {
  if (!text) return null;
  const values = text.split(',').map(Number);
  return values.every(Number.isFinite) ? values : null;
}

/** Millimetres are enough for a camera. */
function short(value: number): string {
  return String(Number(value.toFixed(3)));
}
