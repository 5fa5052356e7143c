import type { Material } from 'three';

/** Makes a material draw limbs: its vertex shader builds their surface from the instance's attributes. */
export function drawLimbs<M extends Material>(material: M): M {
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', `#include <common>\n${DECLARATIONS}`)
      .replace('#include <beginnormal_vertex>', `${SURFACE}\nvec3 objectNormal = limbNormal;`)
      .replace(
        '#include <begin_vertex>',
        // The depth material has no normals, and so no surface yet.
        `#ifndef LIMB_SURFACE\n${SURFACE}\n#endif\nvec3 transformed = limbPoint;`,
      );
  };
  material.customProgramCacheKey = () => 'limb';
  return material;
}

const DECLARATIONS = /* glsl */ `
attribute vec4 limbPlace;    // start x, y, z; length
attribute vec4 limbTurn;     // quaternion x, y, z, w
attribute vec4 limbSections; // start broad, start deep, end broad, end deep
attribute vec4 limbShape;    // bulge, bow, start cap, end cap

vec3 turnedBy(vec4 turn, vec3 way) {
  return way + 2.0 * cross(turn.xyz, cross(turn.xyz, way) + turn.w * way);
}
`;

// The normal is the cross product of the surface's two tangents. Around a cap's pole both radii are taken without the
// latitude's cosine, which changes only the length of a tangent and keeps it from vanishing at the pole.
const SURFACE = /* glsl */ `
#define LIMB_SURFACE
float along = position.x;
vec2 around = normal.xy;
float hump = 4.0 * along * (1.0 - along);
float slope = 4.0 - 8.0 * along;
vec2 radii = mix(limbSections.xy, limbSections.zw, along) + limbShape.x * hump;
float reach = along < 0.5 ? limbShape.z : limbShape.w;
vec2 ring = radii * around;
vec3 limbPoint = vec3(
  along * limbPlace.w + reach * position.y,
  ring.x * position.z,
  ring.y * position.z + limbShape.y * hump
);
vec3 acrossTangent = vec3(0.0, -radii.x * around.y, radii.y * around.x);
bool onCap = abs(position.y) > 0.0001;
vec2 taper = limbSections.zw - limbSections.xy + limbShape.x * slope;
vec3 alongTangent = onCap
  ? vec3(reach * position.z, -ring * position.y)
  : vec3(limbPlace.w, taper * around + vec2(0.0, limbShape.y * slope));
// Where shaft and cap meet, the shaft's slope is only half of the truth.
bool onSeam = !onCap && (along < 0.001 || along > 0.999);
if (onSeam) alongTangent = mix(alongTangent, vec3(max(limbPlace.w, 0.001), 0.0, 0.0), 0.5);
vec3 limbNormal = turnedBy(limbTurn, normalize(cross(acrossTangent, alongTangent)));
limbPoint = limbPlace.xyz + turnedBy(limbTurn, limbPoint);
`;
