import { Float32BufferAttribute, InstancedBufferGeometry } from 'three';

/** How finely a limb is cut. */
export interface Fineness {
  sides: number;
  /** Rings of each rounded end. */
  capRings: number;
  /** Rings between the ends. */
  shaftRings: number;
}

/**
 * The surface that every limb is an instance of. Its vertices are parameters, which the shader makes a surface of:
 * `position` is (how far along, sine of the cap's latitude, cosine of it), `normal` the cosine and sine of the angle
 * around.
 */
export function limbGeometry({ sides, capRings, shaftRings }: Fineness): InstancedBufferGeometry {
  const rings = [...cap(capRings, -1), ...shaft(shaftRings), ...cap(capRings, 1)];
  const position: number[] = [];
  const normal: number[] = [];
  for (const [along, latitude] of rings) {
    for (let side = 0; side <= sides; side += 1) {
      const angle = (2 * Math.PI * side) / sides;
      position.push(along, Math.sin(latitude), Math.cos(latitude));
      normal.push(Math.cos(angle), Math.sin(angle), 0);
    }
  }
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(position, 3));
  // By this name, or three takes the surface for one without normals and shades each triangle flat.
  geometry.setAttribute('normal', new Float32BufferAttribute(normal, 3));
  geometry.setIndex(faces(rings.length, sides));
  return geometry;
}

type Ring = [along: number, latitude: number];

function cap(rings: number, end: -1 | 1): Ring[] {
  const along = end < 0 ? 0 : 1;
  const latitudes = Array.from({ length: rings }, (_, ring) => ((ring + 1) / rings) * (Math.PI / 2));
  return end < 0 ? latitudes.reverse().map((angle) => [along, -angle]) : latitudes.map((angle) => [along, angle]);
}

function shaft(rings: number): Ring[] {
  return Array.from({ length: rings + 2 }, (_, ring) => [ring / (rings + 1), 0]);
}

function faces(rings: number, sides: number): number[] {
  const index: number[] = [];
  for (let ring = 0; ring + 1 < rings; ring += 1) {
    for (let side = 0; side < sides; side += 1) {
      const a = ring * (sides + 1) + side;
      const b = a + sides + 1;
      index.push(a, a + 1, b, a + 1, b + 1, b);
    }
  }
  return index;
}
