import type { Material } from 'three';

/**
 * Makes a material put out its colours as they are: they are the display's already, not linear. The power function of
 * the usual conversion, for every pixel of ground and sky, is a large part of a frame where a processor draws.
 */
export function displayed<M extends Material>(material: M): M {
  material.toneMapped = false;
  const before = material.onBeforeCompile;
  material.onBeforeCompile = (shader, renderer) => {
    before.call(material, shader, renderer);
    shader.fragmentShader = shader.fragmentShader.replace('#include <colorspace_fragment>', GRAIN);
  };
  material.customProgramCacheKey = () => `displayed ${material.type}`;
  return material;
}

/** Half a step of the screen's colours up or down: dark slopes would show bands otherwise. */
const GRAIN = /* glsl */ `
gl_FragColor.rgb += (fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5) / 255.0;
`;
