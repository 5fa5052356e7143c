import {
  BackSide,
  type BufferGeometry,
  Color,
  Float32BufferAttribute,
  Mesh,
  MeshBasicMaterial,
  type Object3D,
  SphereGeometry,
  type Vector3,
} from 'three';
import { displayed } from './displayed';
import type { Look } from './theme';

/** What is behind everything: the horizon's colour, which grows into the zenith's. */
export class Sky {
  private readonly mesh: Mesh<BufferGeometry, MeshBasicMaterial>;

  constructor(parent: Object3D) {
    // The upper half and a little more: the ground covers the rest.
    const dome = new SphereGeometry(120, 24, 20, 0, 2 * Math.PI, 0, Math.PI * 0.56).rotateX(Math.PI / 2);
    this.mesh = new Mesh(
      dome,
      displayed(new MeshBasicMaterial({ vertexColors: true, side: BackSide, depthTest: false, depthWrite: false })),
    );
    this.mesh.renderOrder = -20;
    this.mesh.frustumCulled = false;
    parent.add(this.mesh);
  }

  /** Takes the colours of a theme: in the corners, since a whole sky of pixels is dear where a processor draws. */
  wear(look: Look): void {
    const corners = this.mesh.geometry.getAttribute('position');
    const colors = new Float32Array(3 * corners.count);
    const [zenith, horizon] = [look.zenith.clone().convertLinearToSRGB(), look.horizon.clone().convertLinearToSRGB()];
    for (let corner = 0; corner < corners.count; corner += 1) {
      const height = Math.min(Math.max(corners.getZ(corner) / 120 / 0.55, 0), 1);
      new Color().lerpColors(horizon, zenith, height * height * (3 - 2 * height)).toArray(colors, 3 * corner);
    }
    this.mesh.geometry.setAttribute('color', new Float32BufferAttribute(colors, 3));
  }

  /** The sky is around whoever looks. */
  surround(eye: Vector3): void {
    this.mesh.position.copy(eye);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
