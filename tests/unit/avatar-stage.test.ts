import { Texture, Vector3 } from 'three';
import { afterEach, describe, expect, it, vi } from 'vitest';
import { OWN_HEIGHT } from '../../web/scene/avatar';
import { LARGEST_TEXTURE, shrinkTextures } from '../../web/scene/avatar-textures';
import { Lights } from '../../web/scene/lights';

describe('the shadow', () => {
  /** Farthest that a dancer of this size comes out in the shadow's picture: 1 is its edge. */
  function reach(size: number): number {
    const lights = new Lights(true);
    lights.fit(size);
    lights.follow(3, -2);
    lights.group.updateMatrixWorld(true);
    const { shadow } = lights.key;
    shadow.updateMatrices(lights.key);
    const box = [-0.45, 0.45];
    const corners = box.flatMap((x) => box.flatMap((z) => [0, OWN_HEIGHT].map((y) => new Vector3(x, y, z))));
    const seen = corners.map((corner) =>
      corner
        .multiplyScalar(size)
        .add(new Vector3(3, 0, -2))
        .project(shadow.camera),
    );
    return Math.max(...seen.flatMap(({ x, y, z }) => [x, y, z].map(Math.abs)));
  }

  it('is whole whatever the height of the dancer, and no coarser for ours', () => {
    expect(reach(1)).toBeLessThan(1);
    expect(reach(4 / OWN_HEIGHT)).toBeLessThan(1);
    expect(reach(0.4)).toBeLessThan(reach(1));
    const lights = new Lights(true);
    lights.fit(0.4);
    expect(lights.key.shadow.camera.right).toBe(new Lights(true).key.shadow.camera.right);
  });
});

describe('textures of a character', () => {
  afterEach(() => vi.unstubAllGlobals());

  const picture = (width: number, height: number) => ({ width, height, close: vi.fn() });
  const textureOf = (image: object) => new Texture(image as ImageBitmap);

  it('are scaled down where they are larger than a stage can show; shared pictures stay shared', async () => {
    const create = vi.fn((_: object, { resizeWidth = 0, resizeHeight = 0 }: ImageBitmapOptions) =>
      Promise.resolve(picture(resizeWidth, resizeHeight)),
    );
    vi.stubGlobal('createImageBitmap', create);
    const [large, small] = [picture(8192, 4096), picture(LARGEST_TEXTURE, 64)];
    const [skin, coat] = [textureOf(large), textureOf(small)];
    const again = skin.clone();
    await shrinkTextures([skin, again, coat]);
    expect(create).toHaveBeenCalledTimes(1);
    expect(skin.image).toMatchObject({ width: LARGEST_TEXTURE, height: LARGEST_TEXTURE / 2 });
    expect(again.image).toBe(skin.image);
    expect(large.close).toHaveBeenCalled();
    expect(coat.image).toBe(small);
    expect(small.close).not.toHaveBeenCalled();
  });

  it('stay as they are where a browser cannot scale them', async () => {
    vi.stubGlobal('createImageBitmap', () => Promise.reject(new Error('no memory')));
    const large = picture(4096, 4096);
    const skin = textureOf(large);
    await shrinkTextures([skin]);
    expect(skin.image).toBe(large);
    expect(large.close).not.toHaveBeenCalled();
  });
});
