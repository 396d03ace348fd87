/** Pictures on a character's skin and clothes, no larger than a stage can show. */
import type { Source, Texture } from 'three';

/** Longest edge, pixels: with its smaller copies such a picture takes 22 MB of the graphics card, one of twice the edge four times that. */
export const LARGEST_TEXTURE = 2048;

/**
 * Scales larger pictures down before they go to the graphics card; textures that share a picture go on sharing it.
 * A picture that cannot be scaled stays as it is.
 */
export async function shrinkTextures(textures: Iterable<Texture>): Promise<void> {
  // The type of what a texture is made from is the loader's business.
  const sources = new Set([...textures].map((texture) => texture.source as Source<unknown>));
  // One after the other: two pictures of 8192 pixels at once are half a gigabyte.
  for (const source of sources) {
    const large = source.data as ImageBitmap | null;
    const longest = Math.max(large?.width ?? 0, large?.height ?? 0);
    if (!large || longest <= LARGEST_TEXTURE) continue;
    const scale = LARGEST_TEXTURE / longest;
    try {
      source.data = await createImageBitmap(large, {
        resizeWidth: Math.max(1, Math.round(large.width * scale)),
        resizeHeight: Math.max(1, Math.round(large.height * scale)),
        resizeQuality: 'high',
        // As the loader reads them: colours are not to be changed by what is see-through, nor by the screen.
        premultiplyAlpha: 'none',
        colorSpaceConversion: 'none',
      });
      source.needsUpdate = true;
      (large as Partial<ImageBitmap>).close?.();
    } catch {
      continue;
    }
  }
}
