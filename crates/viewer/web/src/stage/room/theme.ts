import { Color } from 'three';
import type { Theme } from '../options';

/** The colours of the room and of what is neutral in it. */
export interface Look {
  zenith: Color;
  horizon: Color;
  floor: Color;
  line: Color;
  /** What shadows on the floor tend to, and how far. */
  shade: Color;
  shadow: number;
  skyLight: Color;
  groundLight: Color;
  ambient: number;
  key: number;
  rim: number;
  exposure: number;
  skin: Color;
  visor: Color;
  object: Color;
  marker: Color;
  /** What lies on the ground as light: contacts. */
  glow: Color;
  tag: { ground: string; ink: string; faint: string; edge: string };
}

export const LOOKS: Record<Theme, Look> = {
  dark: {
    zenith: new Color('#0b0e13'),
    horizon: new Color('#161b22'),
    floor: new Color('#262d37'),
    line: new Color('#56647a'),
    shade: new Color('#05070a'),
    shadow: 0.62,
    skyLight: new Color('#c3d2ea'),
    groundLight: new Color('#4b4440'),
    ambient: 1.7,
    key: 2.3,
    rim: 1.6,
    exposure: 1,
    skin: new Color('#cfc9c2'),
    visor: new Color('#20242b'),
    object: new Color('#9aa3ad'),
    marker: new Color('#e8edf4'),
    glow: new Color('#ffffff'),
    tag: { ground: 'rgba(13,17,23,0.78)', ink: '#f0f3f7', faint: '#a9b4c2', edge: 'rgba(255,255,255,0.10)' },
  },
  light: {
    zenith: new Color('#f9fafc'),
    horizon: new Color('#eceff3'),
    floor: new Color('#dde2e8'),
    line: new Color('#b3bcc8'),
    shade: new Color('#5b6676'),
    shadow: 0.55,
    skyLight: new Color('#ffffff'),
    groundLight: new Color('#b5afa8'),
    ambient: 1.75,
    key: 2.1,
    rim: 0.6,
    exposure: 1,
    skin: new Color('#d9d4ce'),
    visor: new Color('#2b3038'),
    object: new Color('#8b949e'),
    marker: new Color('#3c4654'),
    glow: new Color('#20262e'),
    tag: { ground: 'rgba(255,255,255,0.88)', ink: '#171c23', faint: '#4d5866', edge: 'rgba(10,20,30,0.12)' },
  },
};
