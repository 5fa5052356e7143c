import { Box3, Vector3 } from 'three';

/** The box in which everybody was lately: it grows at once and shrinks slowly, so that a view of it can rest. */
export class Reach {
  private readonly box = new Box3();

  add(points: Vector3[]): void {
    const now = new Box3().setFromPoints(points);
    if (!this.box.isEmpty()) {
      this.box.min.lerp(now.min, FADING);
      this.box.max.lerp(now.max, FADING);
    }
    this.box.union(now);
  }

  forget(): void {
    this.box.makeEmpty();
  }

  /**
   * The corners of what is to be seen of it, with room for a few steps over the ground: no more than so many metres beyond
   * the points that are now.
   */
  corners(points: Vector3[], beyond: number): Vector3[] {
    const near = new Box3().setFromPoints(points).expandByVector(new Vector3(beyond, beyond, 0.5));
    const { min, max } = this.box.clone().intersect(near).expandByVector(new Vector3(STEPS, STEPS, 0.05));
    return [min.x, max.x].flatMap((x) => [min.y, max.y].flatMap((y) => [min.z, max.z].map((z) => new Vector3(x, y, z))));
  }
}

/** The share by which it shrinks with each sample that is drawn: half in about six seconds. */
const FADING = 0.002;
/** Metres that somebody may go before the view moves again. */
const STEPS = 0.7;
