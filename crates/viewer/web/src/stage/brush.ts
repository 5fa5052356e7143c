import {
  Color,
  type Material,
  MeshBasicMaterial,
  MeshLambertMaterial,
  MeshStandardMaterial,
  type Object3D,
  ShaderMaterial,
} from 'three';
import { Boxes } from './batch/boxes';
import { Disks } from './batch/disks';
import { Limbs } from './batch/limbs';
import { Lines } from './batch/lines';

/** Everything that is drawn anew with each sample: one draw call for each, however many performers there are. */
export class Brush {
  /** For performers who fill the picture, where there is the time. */
  readonly close = new Limbs({ sides: 32, capRings: 8, shaftRings: 7 }, cloth());
  readonly near = new Limbs({ sides: 18, capRings: 4, shaftRings: 5 }, cloth());
  /** For performers who are small in the picture, and for those who are hardly more than a dot. */
  readonly far = new Limbs({ sides: 8, capRings: 2, shaftRings: 0 }, felt());
  readonly tiny = new Limbs({ sides: 4, capRings: 2, shaftRings: 0 }, felt());
  readonly fine = new Limbs({ sides: 7, capRings: 2, shaftRings: 0 }, felt());
  readonly ghost = new Limbs({ sides: 12, capRings: 3, shaftRings: 2 }, mist());
  readonly balls = new Limbs(
    { sides: 10, capRings: 4, shaftRings: 0 },
    new MeshBasicMaterial({ vertexColors: true, toneMapped: false }),
  );
  /** What is inside bodies and shall be seen through them. */
  readonly inner = new Limbs({ sides: 16, capRings: 5, shaftRings: 0 }, inside());
  readonly boxes = new Boxes(cloth());
  readonly lines = new Lines(false);
  readonly topLines = new Lines(true);
  readonly disks = new Disks();
  private readonly all = [
    this.close,
    this.near,
    this.far,
    this.tiny,
    this.fine,
    this.ghost,
    this.balls,
    this.inner,
    this.boxes,
    this.lines,
    this.topLines,
    this.disks,
  ];

  constructor(parent: Object3D) {
    for (const batch of this.all) parent.add(batch.mesh);
    for (const batch of [this.close, this.near, this.far, this.tiny, this.fine, this.boxes])
      batch.mesh.castShadow = true;
    for (const batch of [this.close, this.near, this.boxes]) batch.mesh.receiveShadow = true;
    this.disks.mesh.renderOrder = 1;
    this.ghost.mesh.renderOrder = 5;
    this.lines.mesh.renderOrder = 6;
    this.topLines.mesh.renderOrder = 20;
    this.inner.mesh.renderOrder = 21;
  }

  begin(): void {
    for (const batch of this.all) batch.begin();
  }

  end(): void {
    for (const batch of this.all) batch.end();
  }

  resize(width: number, height: number): void {
    this.lines.resize(width, height);
    this.topLines.resize(width, height);
  }

  dispose(): void {
    for (const batch of this.all) batch.dispose();
  }
}

/** What bodies are made of: dull. */
function cloth(): Material {
  return new MeshStandardMaterial({ vertexColors: true, roughness: 0.62, metalness: 0 });
}

/** The same without any gloss, for what is small: it costs half. */
function felt(): Material {
  return new MeshLambertMaterial({ vertexColors: true });
}

function inside(): Material {
  return new MeshBasicMaterial({ vertexColors: true, transparent: true, depthTest: false, toneMapped: false });
}

/** A segment where it was last: seen through, its outline stronger than its middle. */
function mist(): Material {
  return new ShaderMaterial({
    vertexColors: true,
    transparent: true,
    depthWrite: false,
    uniforms: { tint: { value: new Color('#ffffff') } },
    vertexShader: /* glsl */ `
      #include <common>
      varying vec3 vNormal_;
      varying vec3 vEye;
      varying vec3 vTint;
      void main() {
        #include <beginnormal_vertex>
        #include <begin_vertex>
        vec4 seen = modelViewMatrix * vec4(transformed, 1.0);
        vNormal_ = normalMatrix * objectNormal;
        vEye = -seen.xyz;
        vTint = color;
        gl_Position = projectionMatrix * seen;
      }`,
    fragmentShader: /* glsl */ `
      varying vec3 vNormal_;
      varying vec3 vEye;
      varying vec3 vTint;
      void main() {
        float facing = abs(dot(normalize(vNormal_), normalize(vEye)));
        gl_FragColor = vec4(vTint, 0.05 + 0.42 * pow(1.0 - facing, 1.8));
        #include <colorspace_fragment>
      }`,
  });
}
