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
      this.chosen = true;
      this.flight = null;
    });
    this.controls.update();
  }

  resize(width: number, height: number): void {
    this.camera.aspect = width / Math.max(height, 1);
    this.camera.updateProjectionMatrix();
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
    if (goal) this.flyTo(goal, this.camera.position.clone().sub(this.controls.target).add(goal));
  }

  /** Looks at points from a side, so that all are seen. `sudden` leaves out the way there. */
  look(preset: Preset, points: Vector3[], sudden = calm()): void {
    const { fov, aspect } = this.camera;
    const direction = preset === 'free' ? bestDirection(points, FREE, fov, aspect) : DIRECTIONS[preset];
    const { target, distance } = fit(points, direction, fov, aspect);
    this.flyTo(target, target.clone().addScaledVector(direction, distance), sudden);
  }

  /** Whether a point is in the picture, and not at its very edge. */
  sees(point: Vector3): boolean {
    const { x, y, z } = point.clone().project(this.camera);
    return Math.abs(x) < 0.97 && Math.abs(y) < 0.97 && z < 1;
  }

  /** Moves so far, from the same side and without haste, that all points are seen again. */
  widen(points: Vector3[]): void {
    if (this.flight) return;
    const direction = this.camera.position.clone().sub(this.controls.target).normalize();
    const { target, distance } = fit(points, direction, this.camera.fov, this.camera.aspect);
    this.flyTo(target, target.clone().addScaledVector(direction, distance), calm(), 3 * FLIGHT);
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
    const share = 1 - Math.exp(-seconds * 7);
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

/** From what is looked at to the eye. From above, +X is up on the screen. */
const DIRECTIONS: Record<Exclude<Preset, 'free'>, Vector3> = {
  front: new Vector3(1, 0, 0.16).normalize(),
  side: new Vector3(0, -1, 0.16).normalize(),
  top: new Vector3(-0.002, 0, 1).normalize(),
};

/** From ahead and a little above, the likeliest to please first. */
const FREE = [-38, 38, -52, 52, 0].map((degrees) => {
  const angle = MathUtils.degToRad(degrees);
  return new Vector3(Math.cos(angle), Math.sin(angle), 0.3).normalize();
});

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
