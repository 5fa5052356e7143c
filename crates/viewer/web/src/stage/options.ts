import type { Vector } from '../protocol/types';

export type Theme = 'dark' | 'light';

/** What the stage shows beside the performers' bodies. */
export interface StageOptions {
  /** The local axes of each segment. */
  axes: boolean;
  /** The ways that head, hands, feet and pelvis went. */
  trails: boolean;
  names: boolean;
  /** The centre of mass and its projection onto the ground. */
  com: boolean;
  markers: boolean;
  theme: Theme;
  /** The subjects that are not drawn. */
  hidden: Set<number>;
}

export const DEFAULTS: StageOptions = {
  axes: false,
  trails: false,
  names: true,
  com: false,
  markers: true,
  theme: 'dark',
  hidden: new Set(),
};

/** From where the camera looks: at the faces of those who face +X, from their right, from above, or freely. */
export type Preset = 'front' | 'side' | 'top' | 'free';

/** The camera, to be kept or shared: metres, Z up. */
export interface ViewState {
  position: Vector;
  target: Vector;
  follow: number | null;
}

/** What tests and the page read from the stage. */
export interface StageStats {
  /** Frames drawn in the last second. */
  fps: number;
  /** The step of quality that is drawn, 0 the best. */
  quality: number;
  /** Whether a processor draws, for want of a graphics card: what is dear there had better be left out. */
  software: boolean;
  /** Draw calls and triangles of the last frame. */
  calls: number;
  triangles: number;
  /** The segments' origins as they are drawn: x, y, z each, metres, Z up; NaN where a segment was never seen. */
  positions(id: number): Float32Array;
}
