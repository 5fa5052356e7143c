import {
  type Color,
  DynamicDrawUsage,
  InstancedMesh,
  type Material,
  Matrix4,
  type Quaternion,
  type Vector3,
} from 'three';
import { RoundedBoxGeometry } from 'three/addons/geometries/RoundedBoxGeometry.js';

/** Boxes with rounded edges, in one draw call. Every frame: `begin`, `add` each, `end`. */
export class Boxes {
  readonly mesh: InstancedMesh;
  private count = 0;

  constructor(material: Material) {
    material.vertexColors = false;
    this.mesh = new InstancedMesh(new RoundedBoxGeometry(1, 1, 1, 3, 0.14), material, MOST);
    this.mesh.frustumCulled = false;
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
  }

  begin(): void {
    this.count = 0;
  }

  /** A box around a place, its sides in metres; what is more than a scene can sensibly have is not drawn. */
  add(at: Vector3, turn: Quaternion, size: Vector3, color: Color): void {
    if (this.count >= MOST) return;
    this.mesh.setMatrixAt(this.count, new Matrix4().compose(at, turn, size));
    this.mesh.setColorAt(this.count, color);
    this.count += 1;
  }

  end(): void {
    this.mesh.count = this.count;
    this.mesh.visible = this.count > 0;
    this.mesh.instanceMatrix.needsUpdate = true;
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    (this.mesh.material as Material).dispose();
    this.mesh.dispose();
  }
}

const MOST = 512;
