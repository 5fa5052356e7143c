import { MathUtils, PerspectiveCamera, Spherical, Vector3 } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { bestDirection, fit } from './fit';
import type { Preset, ViewState } from './options';

/** The eye: orbit, pan and zoom by hand, views at a key's press, and going along with a performer. */
export class Eye {
  readonly camera = new PerspectiveCamera(36, 1, 0.05, 400);
  private readonly controls: OrbitControls;
  private flight: Flight | null = null;
  private along: Vector3 | null = null;
  /** The picture's size and how much of it lies under other things above and below, CSS pixels. */
  private picture: Picture = { width: 1, height: 1, top: 0, bottom: 0 };
  private held: Vector3 | null = null;
  /** Whether somebody chose a view, so that none is chosen for them any more. */
  chosen = false;

  constructor(canvas: HTMLElement, onChange: () => void) {
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(4.2, -3.4, 2.3);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.target.set(0, 0, 0.9);
    this.controls.enableDamping = !calm();
    this.controls.dampingFactor = 0.12;
    this.controls.minDistance = 0.35;
    this.controls.maxDistance = 160;
    this.controls.maxPolarAngle = MathUtils.degToRad(96);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', onChange);
    this.controls.addEventListener('start', () => {
      this.held = this.offset();
      this.flight = null;
    });
    this.controls.addEventListener('end', () => {
      if (this.held && this.held.distanceTo(this.offset()) > 1e-4) this.chosen = true;
      this.held = null;
    });
    this.controls.update();
  }

  /** What is looked at lies in the middle of the part of the picture that nothing covers. */
  resize(picture: Picture): void {
    this.picture = picture;
    const { width, height, top, bottom } = picture;
    this.camera.aspect = width / Math.max(height, 1);
    this.camera.setViewOffset(width, height, 0, (bottom - top) / 2, width, height);
  }

  /** One step of time. `goal` is where the followed performer is. True while the view is on its way. */
  update(seconds: number, goal: Vector3 | null): boolean {
    const went = this.goAlong(seconds, goal);
    const flying = this.fly(seconds);
    this.controls.update();
    return went || flying;
  }

  /** Begins to go along with whoever is at `goal`, or stops to. */
  follow(goal: Vector3 | null): void {
    this.along = goal?.clone() ?? null;
  }

  /** Brings points into the middle, as large as can be, from the side where it is. */
  centre(points: Vector3[], seconds = FLIGHT): void {
    this.frame(points, this.offset().normalize(), calm(), seconds);
  }

  /** Looks at points from a side of what faces so many radians from +X, so that all are seen. `sudden` leaves out the way. */
  look(preset: Preset, points: Vector3[], facing: number, sudden = calm()): void {
    const sides = SIDES[preset].map((side) => side.clone().applyAxisAngle(this.camera.up, facing));
    const { fov, aspect } = this.lens();
    this.frame(points, bestDirection(points, sides, fov, aspect), sudden);
  }

  /** Whether a point is in the picture, and under nothing that covers it. */
  sees(point: Vector3): boolean {
    const { x, y, z } = point.clone().project(this.camera);
    const { height, top, bottom } = this.picture;
    const [highest, lowest] = [1 - top / height, (2 * bottom) / height - 1];
    return Math.abs(x) < 0.98 && y < highest && y > lowest && z < 1;
  }

  /** Moves so far, from the same side and without haste, that all points are seen again. */
  widen(points: Vector3[]): void {
    if (!this.flight && !this.held) this.centre(points, 2 * FLIGHT);
  }

  view(): Omit<ViewState, 'follow'> {
    return { position: this.camera.position.toArray(), target: this.controls.target.toArray() };
  }

  setView({ position, target }: Omit<ViewState, 'follow'>): void {
    this.chosen = true;
    this.flyTo(new Vector3(...target), new Vector3(...position), true);
  }

  /** Where it looks. */
  get target(): Vector3 {
    return this.controls.target;
  }

  dispose(): void {
    this.controls.dispose();
  }

  private offset(): Vector3 {
    return this.camera.position.clone().sub(this.controls.target);
  }

  private frame(points: Vector3[], direction: Vector3, sudden: boolean, seconds = FLIGHT): void {
    const { fov, aspect } = this.lens();
    const { target, distance } = fit(points, direction, fov, aspect);
    this.flyTo(target, target.clone().addScaledVector(direction, distance), sudden, seconds);
  }

  /** The lens of the part of the picture that nothing covers. */
  private lens(): { fov: number; aspect: number } {
    const { width, height, top, bottom } = this.picture;
    const free = Math.max(height - top - bottom, height / 3);
    const slope = Math.tan(MathUtils.degToRad(this.camera.fov / 2)) * (free / height);
    return { fov: MathUtils.radToDeg(2 * Math.atan(slope)), aspect: width / free };
  }

  private flyTo(target: Vector3, position: Vector3, sudden = calm(), seconds = FLIGHT): void {
    const now = new Spherical().setFromVector3(toYUp(this.camera.position.clone().sub(this.controls.target)));
    const then = new Spherical().setFromVector3(toYUp(position.clone().sub(target)));
    // The shorter way round.
    now.theta += 2 * Math.PI * Math.round((then.theta - now.theta) / (2 * Math.PI));
    this.flight = { from: this.controls.target.clone(), to: target.clone(), now, then, seconds, done: sudden ? 1 : 0 };
    if (sudden) this.fly(0);
  }

  private fly(seconds: number): boolean {
    const flight = this.flight;
    if (!flight) return false;
    flight.done = Math.min(flight.done + seconds / flight.seconds, 1);
    const eased = MathUtils.smootherstep(flight.done, 0, 1);
    const { now, then } = flight;
    const at = new Spherical(
      Math.exp(MathUtils.lerp(Math.log(now.radius), Math.log(then.radius), eased)),
      MathUtils.lerp(now.phi, then.phi, eased),
      MathUtils.lerp(now.theta, then.theta, eased),
    );
    this.controls.target.lerpVectors(flight.from, flight.to, eased);
    this.camera.position.copy(this.controls.target).add(toZUp(new Vector3().setFromSpherical(at)));
    if (flight.done === 1) this.flight = null;
    return true;
  }

  private goAlong(seconds: number, goal: Vector3 | null): boolean {
    if (!this.along || !goal) {
      this.along = goal?.clone() ?? null;
      return false;
    }
    const share = 1 - Math.exp(-seconds * 20);
    const step = goal
      .clone()
      .sub(this.along)
      .multiply(new Vector3(share, share, share * 0.3));
    if (step.lengthSq() < 1e-10) return false;
    for (const place of [this.along, this.camera.position, this.controls.target, this.flight?.from, this.flight?.to]) {
      place?.add(step);
    }
    return true;
  }
}

/** A picture and how much of it is covered above and below, CSS pixels. */
export interface Picture {
  width: number;
  height: number;
  top: number;
  bottom: number;
}

interface Flight {
  from: Vector3;
  to: Vector3;
  now: Spherical;
  then: Spherical;
  seconds: number;
  done: number;
}

/** Seconds from one view to another. */
const FLIGHT = 0.55;

/** From what is looked at to the eye, `degrees` from ahead and so steep. */
function from(degrees: number, steep: number): Vector3 {
  const angle = MathUtils.degToRad(degrees);
  return new Vector3(Math.cos(angle), Math.sin(angle), steep).normalize();
}

/**
 * The sides from which is looked: the first, unless from another all are much closer, as those who stand in a long row.
 * Freely from ahead and a little above, the likeliest to please. From above, ahead is up on the screen.
 */
const SIDES: Record<Preset, Vector3[]> = {
  free: [-38, 38, -52, 52, 0].map((degrees) => from(degrees, 0.3)),
  front: [0, -20, 20, -45, 45].map((degrees) => from(degrees, 0.16)),
  side: [-90, -110, -70, -135, -45].map((degrees) => from(degrees, 0.16)),
  top: [new Vector3(-0.002, 0, 1).normalize()],
};

/** Whether whoever sits there asked the system for less motion. */
function calm(): boolean {
  return typeof matchMedia === 'function' && matchMedia('(prefers-reduced-motion: reduce)').matches;
}

/** Spherical coordinates have their pole along y. */
function toYUp(way: Vector3): Vector3 {
  return way.set(way.x, way.z, -way.y);
}

function toZUp(way: Vector3): Vector3 {
  return way.set(way.x, -way.z, way.y);
}
