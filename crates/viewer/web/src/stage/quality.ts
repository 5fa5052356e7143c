/** What one step of quality costs and shows. */
export interface QualityStep {
  /** The most pixels drawn for each CSS pixel's side. */
  pixelRatio: number;
  /** The side of the shadow map; 0: soft disks alone. */
  shadows: number;
}

/** From the best to what a machine without a graphics card draws. */
export const QUALITY: readonly QualityStep[] = [
  { pixelRatio: 2, shadows: 2048 },
  { pixelRatio: 1.5, shadows: 2048 },
  { pixelRatio: 1, shadows: 1024 },
  { pixelRatio: 1, shadows: 0 },
  { pixelRatio: 0.85, shadows: 0 },
  { pixelRatio: 0.75, shadows: 0 },
];

/** The step that a machine without a graphics card begins with. */
export const SLOW_START = 3;

/** For a picture that has time: when nothing moves, and screenshots. More pixels than the screen has smooth edges. */
export const STILL: QualityStep = { pixelRatio: 2, shadows: 2048 };

/**
 * Picks the step of quality that holds the frame rate: down when frames take long, up again when there is time, and
 * ever more slowly up to a step that was too much before. Time is an argument.
 */
export class AdaptiveQuality {
  private spent = 0;
  private frames = 0;
  private calm = 0;
  private patience: number[] = QUALITY.map(() => 4);

  constructor(public step = 0) {}

  /** Takes the time that a frame took, in milliseconds. True when the step changed. */
  frame(milliseconds: number): boolean {
    // A tab in the background, a breakpoint: not the drawing's fault.
    if (milliseconds > 500) return false;
    this.spent += milliseconds;
    this.frames += 1;
    if (this.frames < WINDOW) return false;
    const mean = this.spent / this.frames;
    this.spent = this.frames = 0;
    if (mean > SLOW) return this.lower();
    this.calm = mean < QUICK ? this.calm + 1 : 0;
    return this.calm >= (this.patience[this.step - 1] ?? Infinity) ? this.raise() : false;
  }

  private lower(): boolean {
    this.calm = 0;
    if (this.step + 1 >= QUALITY.length) return false;
    this.patience[this.step] = Math.min((this.patience[this.step] ?? 4) * 4, 400);
    this.step += 1;
    return true;
  }

  private raise(): boolean {
    this.calm = 0;
    if (this.step === 0) return false;
    this.step -= 1;
    return true;
  }
}

/** Frames of one judgement. */
const WINDOW = 24;
/** Milliseconds a frame on the mean: below 36 Hz is slow; 50 Hz and more leaves time. */
const SLOW = 28;
const QUICK = 19;
