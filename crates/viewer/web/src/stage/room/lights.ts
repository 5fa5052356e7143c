import { DirectionalLight, HemisphereLight, type Object3D, Vector3 } from 'three';
import type { Look } from './theme';

/** Light from everywhere, a key light that casts shadows and goes where the interest is, and a rim from behind. */
export class Lights {
  private readonly ambient = new HemisphereLight();
  private readonly key = new DirectionalLight('#fff3e4');
  private readonly rim = new DirectionalLight('#cfe0ff');

  constructor(parent: Object3D) {
    this.ambient.position.set(0, 0, 1);
    this.key.shadow.bias = -0.0006;
    this.key.shadow.normalBias = 0.02;
    this.key.shadow.radius = 3;
    this.rim.position.copy(RIM);
    parent.add(this.ambient, this.key, this.key.target, this.rim);
  }

  wear(look: Look): void {
    this.ambient.color.copy(look.skyLight);
    this.ambient.groundColor.copy(look.groundLight);
    this.ambient.intensity = look.ambient;
    this.key.intensity = look.key;
    this.rim.intensity = look.rim;
  }

  /** Shadows of so many pixels' side; 0 for none. */
  set shadows(size: number) {
    this.key.castShadow = size > 0;
    if (size === 0 || this.key.shadow.mapSize.x === size) return;
    this.key.shadow.mapSize.set(size, size);
    this.key.shadow.map?.dispose();
    this.key.shadow.map = null;
  }

  /** Lights, and lets cast shadows, what is within so many metres of a place. */
  attend(centre: Vector3, radius: number): void {
    const reach = Math.min(Math.max(radius * 1.15 + 0.6, 2.2), 16);
    const grid = (2 * reach) / this.key.shadow.mapSize.x;
    // Whole pixels of the shadow, or its edges crawl when the place moves.
    const at = new Vector3(snap(centre.x, grid), snap(centre.y, grid), 0.9);
    this.key.target.position.copy(at);
    this.key.position.copy(at).addScaledVector(KEY, 14);
    const { camera } = this.key.shadow;
    camera.left = camera.bottom = -reach;
    camera.right = camera.top = reach;
    camera.near = Math.max(14 - reach * 1.6, 0.5);
    camera.far = 14 + reach * 1.6;
    camera.updateProjectionMatrix();
  }

  dispose(): void {
    for (const light of [this.ambient, this.key, this.rim]) light.dispose();
  }
}

/** Towards the key light: high, ahead and to the left of those who face +X. */
const KEY = new Vector3(0.42, 0.5, 0.95).normalize();
const RIM = new Vector3(-0.7, -0.75, 0.45);

function snap(value: number, grid: number): number {
  return Math.round(value / grid) * grid;
}
