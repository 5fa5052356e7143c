import type { Subject, SubjectRecord, Vector } from '../protocol/types';

/** What the stage shows beside the performers' bodies. */
export interface StageOptions {
  /** The local axes of each segment. */
  axes: boolean;
  /** The ways that hands, feet, head and pelvis went. */
  trails: boolean;
  names: boolean;
  /** Centre of mass and its projection onto the ground. */
  com: boolean;
  markers: boolean;
  theme: 'dark' | 'light';
  /** Subjects that are not drawn. */
  hidden: Set<number>;
}

/** From where the camera looks at the performers. */
export type Preset = 'front' | 'side' | 'top' | 'free';

/** The camera, to be kept or shared: metres, Z up. */
export interface ViewState {
  position: Vector;
  target: Vector;
  follow: number | null;
}

/** What tests read from the stage. */
export interface StageStats {
  /** Frames drawn in each second, over the last second or so. */
  fps: number;
  /** The segments' origins as they are drawn: x, y, z per segment, metres, Z up; NaN where not drawn. */
  positions(id: number): Float32Array;
}

/** The room in which performers are drawn. */
export class Stage {
  /** Called with the subject that was clicked, or null for none. */
  onSelect: ((id: number | null) => void) | null = null;

  constructor(readonly canvas: HTMLCanvasElement) {}
  setSubjects(_subjects: Subject[]): void {}
  update(_records: SubjectRecord[]): void {}
  setOptions(_options: Partial<StageOptions>): void {}
  follow(_id: number | null): void {}
  preset(_preset: Preset): void {}
  view(): ViewState {
    return { position: [4, 0, 2], target: [0, 0, 1], follow: null };
  }
  setView(_view: ViewState): void {}
  screenshot(): Promise<Blob> {
    return new Promise((resolve, reject) =>
      this.canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('no picture')))),
    );
  }
  stats(): StageStats {
    return { fps: 0, positions: () => new Float32Array() };
  }
  dispose(): void {}
}
