import { MToonMaterial, VRMUtils } from '@pixiv/three-vrm';
import {
  Bone,
  BoxGeometry,
  BufferGeometry,
  Group,
  InstancedMesh,
  Line,
  LineBasicMaterial,
  Mesh,
  MeshStandardMaterial,
  Skeleton,
  SkinnedMesh,
  Texture,
  Vector3,
  type EventDispatcher,
  type Object3D,
} from 'three';
import { afterEach, describe, expect, it, vi } from 'vitest';
import { OWN_HEIGHT } from '../../web/scene/avatar';
import { disposeScene } from '../../web/scene/avatar-load';
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

describe('a character that is taken away', () => {
  /** All kinds of parts that a file can bring, and the stage's shadow in the toon material as three puts it there. */
  function character() {
    const names = ['map', 'shadeMultiplyTexture', 'rimMultiplyTexture', 'outlineWidthMultiplyTexture'] as const;
    const toonMaps = names.map(() => new Texture());
    const toon = new MToonMaterial(Object.fromEntries(names.map((name, i) => [name, toonMaps[i]])));
    const close = vi.fn();
    const outlineMap = new Texture({ width: 1, height: 1, close } as unknown as ImageBitmap);
    const outline = new MToonMaterial({ map: outlineMap, isOutline: true });
    const shadow = new Texture();
    Object.assign(toon.uniforms, { directionalShadowMap: { value: [shadow] } });
    const bone = new Bone();
    const skin = new SkinnedMesh(new BoxGeometry(), [toon, outline]);
    skin.bind(new Skeleton([bone]));
    skin.skeleton.computeBoneTexture();
    const hat = new Mesh(new BoxGeometry(), new MeshStandardMaterial({ map: new Texture(), normalMap: new Texture() }));
    const beads = new InstancedMesh(new BoxGeometry(), new MeshStandardMaterial(), 3);
    const wire = new Line(new BufferGeometry(), new LineBasicMaterial());
    const maps = [...toonMaps, outlineMap, hat.material.map!, hat.material.normalMap!];
    const parts = {
      skin: skin.geometry,
      hat: hat.geometry,
      beads: beads.geometry,
      wire: wire.geometry,
      instances: beads,
    };
    const materials = { toon, outline, felt: hat.material, glass: beads.material, copper: wire.material };
    const owned = { ...parts, ...materials, bones: skin.skeleton.boneTexture!, ...maps };
    return { scene: new Group().add(bone, skin, hat, beads, wire), owned, shadow, close };
  }

  /** How often each part is freed. */
  function freed({ scene, owned, shadow }: ReturnType<typeof character>, free: (scene: Object3D) => void) {
    const counts: Record<string, number> = {};
    for (const [name, part] of Object.entries({ ...owned, shadow })) {
      counts[name] = 0;
      (part as EventDispatcher<{ dispose: object }>).addEventListener('dispose', () => (counts[name] += 1));
    }
    free(scene);
    return counts;
  }

  it('frees all it has on the graphics card, pictures of toon materials and bones included, and nothing of the stage', () => {
    const own = character();
    const { shadow, ...counts } = freed(own, disposeScene);
    expect(Object.entries(counts).filter(([, count]) => count === 0)).toEqual([]);
    expect(shadow).toBe(0);
    expect(own.close).toHaveBeenCalled();
  });

  it('frees no less than three-vrm itself', () => {
    const theirs = freed(character(), (scene) => VRMUtils.deepDispose(scene));
    const ours = freed(character(), disposeScene);
    expect(Object.values(theirs).filter((count) => count > 0).length).toBeGreaterThan(15);
    for (const [name, count] of Object.entries(theirs)) if (count > 0) expect(ours[name], name).toBeGreaterThan(0);
  });
});
