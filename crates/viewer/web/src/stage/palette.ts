import { Color } from 'three';
import type { Subject } from '../protocol/types';

/** The colour a subject is drawn in: its own, tempered, or one of the palette when it sends none. */
export function subjectColor(subject: Subject): Color {
  const sent = subject.color?.match(/^[0-9a-f]{6}$/i);
  return sent ? tempered(new Color(`#${sent[0]}`)) : new Color(PALETTE[subject.id % PALETTE.length]);
}

/** The same hue as cloth has it: senders choose pure colours, which glare on a whole body. */
export function tempered(color: Color): Color {
  const hsl = color.getHSL({ h: 0, s: 0, l: 0 });
  return new Color().setHSL(hsl.h, Math.min(hsl.s * 0.78, 0.66), Math.min(Math.max(hsl.l, 0.42), 0.62));
}

/** A colour that lost most of its saturation: a subject whose samples no longer come. */
export function faded(color: Color): Color {
  const hsl = color.getHSL({ h: 0, s: 0, l: 0 });
  return new Color().setHSL(hsl.h, hsl.s * 0.12, hsl.l * 0.85);
}

/** Hues that stay apart from each other, neighbours above all, on dark and on light ground. */
const PALETTE = [
  '#d98452',
  '#4f93c9',
  '#69b378',
  '#b277c4',
  '#d6b04c',
  '#50b0ab',
  '#d0667f',
  '#7d85d6',
  '#a9bd56',
  '#5fb4d9',
  '#c98bb0',
  '#8f9a5a',
  '#d69a7c',
  '#5a76b8',
  '#7fc29b',
  '#b88a5c',
];
