import { Color } from 'three';
import { State } from '../protocol/types';
import type { Tone } from './body/part';
import { faded } from './palette';
import type { Look } from './room/theme';

/** The colours of one subject's parts. */
export type Tones = Record<Tone, Color> & { accent: Color; glow: Color };

/** What a subject of a colour looks like in a state: a stream that stopped loses its colour. */
export function tones(color: Color, state: State, look: Look): Tones {
  const suit = state === State.Live ? color : faded(color);
  const skin = look.skin.clone().lerp(suit, 0.1);
  return {
    suit,
    trousers: suit.clone().lerp(look.visor, 0.5),
    shoe: suit.clone().lerp(look.visor, 0.86),
    skin: state === State.Live ? skin : skin.lerp(look.object, 0.4),
    visor: look.visor,
    object: look.object.clone().lerp(suit, 0.25),
    glow: suit.clone().lerp(look.glow, 0.45),
    accent: suit.clone().lerp(new Color('#ffffff'), 0.25),
  };
}
