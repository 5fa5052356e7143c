/** Asks once for each frame of the screen whether to draw, and counts what was drawn. */
export class Pulse {
  private request = 0;
  private last = 0;
  private drewLast = false;
  private drawn: number[] = [];

  /**
   * `tick` gets the seconds since the last frame of the screen and, when that one was drawn, how many milliseconds it
   * held the next one up; it returns whether it drew.
   */
  constructor(private readonly tick: (seconds: number, sinceDrawn: number | null) => boolean) {}

  start(): void {
    this.last = performance.now();
    this.request = requestAnimationFrame(this.frame);
  }

  stop(): void {
    cancelAnimationFrame(this.request);
  }

  /** How many frames were drawn in the last second. */
  fps(): number {
    const since = performance.now() - 1000;
    return this.drawn.filter((at) => at > since).length;
  }

  private readonly frame = (now: number): void => {
    this.request = requestAnimationFrame(this.frame);
    const spent = Math.max(now - this.last, 0);
    this.last = now;
    this.drewLast = this.tick(Math.min(spent / 1000, 0.5), this.drewLast ? spent : null);
    if (this.drewLast) this.drawn.push(performance.now());
    if (this.drawn.length > 240) this.drawn.splice(0, 120);
  };
}
