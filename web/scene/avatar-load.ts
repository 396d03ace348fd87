/** The picture side of a character's file: three's objects for its nodes. Nothing is ever loaded from anywhere else. No page is needed. */
import {
  InstancedMesh,
  LoadingManager,
  Mesh,
  MeshStandardMaterial,
  SkinnedMesh,
  Sphere,
  Texture,
  type Material,
  type Object3D,
  type ShaderMaterial,
} from 'three';
import { GLTFLoader, type GLTF } from 'three/addons/loaders/GLTFLoader.js';
import type { MToonMaterial, VRM } from '@pixiv/three-vrm';
import { shrinkTextures } from './avatar-textures';

/** A file as three has it. */
export interface LoadedAvatar {
  scene: Object3D;
  /** For each node of the file its object; a node that is not in the scene has none. */
  nodes: (Object3D | undefined)[];
  /** Hair, skirts, constraints and materials of a VRM; null for any other file. */
  vrm: VRM | null;
}

/** The stage has nothing around it that metal could mirror: all metal would be black. */
const MOST_METAL = 0.3;
/** Toon materials take every lamp in full, those behind them too: one lamp is what they are painted for. */
const TOON_LIGHT = 0.6;
/** Any pose of a dancer fits in a ball this many times its height. */
const REACH = 1.2;

/**
 * Builds the objects of a .glb, .vrm or self-contained .gltf file that was looked through before.
 * @throws Error with a sentence for the visitor
 */
export async function loadAvatar(bytes: Uint8Array, isVrm: boolean): Promise<LoadedAvatar> {
  let gltf: GLTF;
  try {
    // Somebody's VRM that three-vrm has something against is a glTF file all the same.
    gltf = isVrm ? await parse(bytes, true).catch(() => parse(bytes, false)) : await parse(bytes, false);
  } catch (error) {
    throw new Error(`The character could not be read (${shortly(error)}): export it again as a .glb or .vrm file.`, {
      cause: error,
    });
  }
  const nodes: (Object3D | undefined)[] = [];
  for (const [object, { nodes: node }] of gltf.parser.associations as Map<Object3D, { nodes?: number }>) {
    // Parts of a node's mesh bear its number too: the node itself is what hangs highest.
    if (node === undefined || !('isObject3D' in object)) continue;
    const known = nodes[node];
    if (!known || isAbove(object, known)) nodes[node] = object;
  }
  suitLight(gltf.scene);
  const textures = [...gltf.parser.associations.keys()].filter((each) => each instanceof Texture);
  await shrinkTextures(textures as Texture[]);
  return { scene: gltf.scene, nodes, vrm: (gltf.userData.vrm as VRM | undefined) ?? null };
}

async function parse(bytes: Uint8Array, isVrm: boolean): Promise<GLTF> {
  const manager = new LoadingManager();
  manager.setURLModifier((url) => {
    if (!/^(blob|data):/.test(url)) throw new Error('it keeps parts of itself in other files');
    return url;
  });
  const loader = new GLTFLoader(manager);
  const [{ MeshoptDecoder }, vrm] = await Promise.all([
    import('three/addons/libs/meshopt_decoder.module.js'),
    isVrm ? import('@pixiv/three-vrm') : null,
  ]);
  loader.setMeshoptDecoder(MeshoptDecoder);
  // The bones are moved by us, as they lie in the file.
  if (vrm) loader.register((parser) => new vrm.VRMLoaderPlugin(parser, { autoUpdateHumanBones: false }));
  return loader.parseAsync(bytes.slice().buffer, '');
}

function shortly(error: unknown): string {
  const text = error instanceof Error ? error.message : String(error);
  return text.replace(/^THREE\.GLTFLoader: /, '').slice(0, 120);
}

function isAbove(object: Object3D, other: Object3D): boolean {
  for (let at = other.parent; at; at = at.parent) if (at === object) return true;
  return false;
}

/** Makes materials fit the stage's lamps. */
function suitLight(scene: Object3D): void {
  const materials = new Set<Material>();
  scene.traverse((object) => {
    if (object instanceof Mesh) for (const each of [object.material].flat() as Material[]) materials.add(each);
  });
  for (const material of materials) {
    if (material instanceof MeshStandardMaterial) material.metalness = Math.min(material.metalness, MOST_METAL);
    const toon = material as Partial<MToonMaterial>;
    if (!toon.isMToonMaterial) continue;
    toon.color?.multiplyScalar(TOON_LIGHT);
    toon.shadeColorFactor?.multiplyScalar(TOON_LIGHT);
  }
}

/** Makes the meshes ready for a stage: they cast shadows and are drawn wherever their bones take them. */
export function prepareMeshes(scene: Object3D, height: number): void {
  scene.traverse((object) => {
    if (!(object instanceof Mesh)) return;
    object.castShadow = true;
    object.receiveShadow = true;
    if (!(object instanceof SkinnedMesh)) return;
    object.frustumCulled = false;
    // Without it three would skin every vertex on the CPU to sort the scene.
    object.boundingSphere = new Sphere(undefined, height * REACH);
  });
}

/** Frees geometries, bone textures, materials and pictures of a scene, lines and points included. */
export function disposeScene(scene: Object3D): void {
  scene.traverse((object) => {
    // An instanced mesh has buffers of its own.
    if (object instanceof InstancedMesh) object.dispose();
    if (object instanceof SkinnedMesh) object.skeleton.dispose();
    const { geometry, material } = object as Partial<Mesh>;
    geometry?.dispose();
    for (const each of material ? [material].flat() : []) {
      for (const texture of texturesOf(each)) {
        texture.dispose();
        (texture.source.data as { close?: () => void } | null)?.close?.();
      }
      each.dispose();
    }
  });
}

/** The pictures that a material brings: toon materials keep theirs in uniforms. The stage's shadows, lists of textures there, stay. */
function texturesOf(material: Material): Texture[] {
  const uniforms = Object.values((material as Partial<ShaderMaterial>).uniforms ?? {});
  const values: unknown[] = [...Object.values(material), ...uniforms.map(({ value }) => value as unknown)];
  return values.filter((value) => value instanceof Texture);
}
