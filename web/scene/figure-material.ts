import { Color, type Material, MeshStandardMaterial } from 'three';
import { coloursOf, DEFAULT_LOOK, type FigureLook } from '../core/figure-look';
import { createNeonMaterial } from './figure-neon';
import { DECLARATIONS, paintOf, SURROUNDINGS } from './figure-paint';

/** Colours of the figure as the shaders have them. */
export interface FigurePalette {
  body: Color;
  left: Color;
  right: Color;
  visor: Color;
}

/** The colours of a look, linear. The middle is neutral; left and right are far apart. */
export function paletteOf(look: Readonly<FigureLook>): FigurePalette {
  const { body, left, right } = coloursOf(look);
  return { body: new Color(body), left: new Color(left), right: new Color(right), visor: new Color('#0b0f17') };
}

/**
 * The material of a look. Another set of colours needs no other shader: {@link recolour}.
 * Reads the geometry's `surface` attribute (openness, part).
 */
export function createFigureMaterial(look: Readonly<FigureLook> = DEFAULT_LOOK): Material {
  const palette = paletteOf(look);
  const { style } = look;
  const material = style === 'neon' ? createNeonMaterial(palette) : litMaterial(style, palette);
  material.userData.palette = palette;
  return material;
}

/** Paints a material of {@link createFigureMaterial} in other colours. */
export function recolour(material: Material, look: Readonly<FigureLook>): void {
  const now = material.userData.palette as FigurePalette;
  const next = paletteOf(look);
  for (const name of ['body', 'left', 'right'] as const) now[name].copy(next[name]);
}

function litMaterial(style: Exclude<FigureLook['style'], 'neon'>, palette: FigurePalette): MeshStandardMaterial {
  const material = new MeshStandardMaterial({ metalness: 0 });
  // The shader is known to three by this, not by the function below, which is the same text for all styles.
  material.customProgramCacheKey = () => `figure ${style}`;
  material.onBeforeCompile = (shader) => {
    for (const [name, colour] of Object.entries(palette)) shader.uniforms[`${name}Colour`] = { value: colour };
    shader.vertexShader = shader.vertexShader
      .replace(
        '#include <common>',
        '#include <common>\nattribute vec2 surface;\nvarying vec3 vRest;\nvarying vec2 vSurface;',
      )
      .replace('#include <begin_vertex>', '#include <begin_vertex>\nvRest = position;\nvSurface = surface;');
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', `#include <common>\n${DECLARATIONS}`)
      .replace('#include <color_fragment>', `#include <color_fragment>\n${paintOf(style)}`)
      .replace(
        '#include <roughnessmap_fragment>',
        '#include <roughnessmap_fragment>\nroughnessFactor = paintRoughness;',
      )
      .replace('#include <aomap_fragment>', SURROUNDINGS[style]);
  };
  return material;
}
