import {
  Bone,
  BufferGeometry,
  DataTexture,
  FloatType,
  type Material,
  Matrix4,
  RGBAFormat,
  Skeleton,
  SkinnedMesh,
  Sphere,
  Vector3,
} from 'three';
import { DEFAULT_LOOK, type FigureLook } from '../core/figure-look';
import type { FramePose } from '../core/types';
import type { FigureAsset } from './figure-asset';
import { createFigureMaterial, recolour } from './figure-material';
import { mannequin } from './mannequin';
import { SKIN_BONES, SkinPose } from './skin-bones';

/** A skeleton whose matrices come from {@link SkinPose} instead of a tree of three.js bones. */
class FigureSkeleton extends Skeleton {
  constructor(readonly source: SkinPose) {
    // three counts bones and takes their inverses; the matrices already hold both.
    super(
      SKIN_BONES.map(() => new Bone()),
      SKIN_BONES.map(() => new Matrix4()),
    );
  }

  override computeBoneTexture(): this {
    const size = Math.ceil(Math.sqrt(SKIN_BONES.length * 4) / 4) * 4;
    const data = new Float32Array(size * size * 4);
    data.set(this.source.matrices);
    this.boneMatrices = data;
    this.boneTexture = new DataTexture(data, size, size, RGBAFormat, FloatType);
    this.boneTexture.needsUpdate = true;
    return this;
  }

  override update(): void {
    // Filled by refresh() when the pose changes, not on every draw.
  }

  refresh(): void {
    this.boneMatrices?.set(this.source.matrices);
    if (this.boneTexture) this.boneTexture.needsUpdate = true;
  }
}

/** A geometry with its own draw range over the shared attributes. */
function ownRange(shared: BufferGeometry): BufferGeometry {
  const own = new BufferGeometry();
  own.setIndex(shared.index);
  for (const [name, attribute] of Object.entries(shared.attributes)) own.setAttribute(name, attribute);
  return own;
}

/** The dancer. Give it poses; add `mesh` to a scene. */
export class Figure {
  readonly mesh: SkinnedMesh;
  /** World positions and rotations of the joints of the last pose. */
  readonly pose = new SkinPose();
  private readonly bounds = new Sphere(new Vector3(), 1.6);
  private readonly skeleton = new FigureSkeleton(this.pose);

  private asset: FigureAsset;
  private look: Readonly<FigureLook> = DEFAULT_LOOK;

  /**
   * @param body shared by all figures
   * @param level of detail, 0 the finest
   * @param material freed with the figure
   */
  constructor(
    private readonly body: FigureAsset,
    private level = 0,
    material: Material = createFigureMaterial(),
  ) {
    this.asset = body;
    this.mesh = new SkinnedMesh(ownRange(body.geometry), material);
    this.draw(level);
    // A shadow needs no fingers: it is drawn with the coarsest triangles.
    this.mesh.onBeforeShadow = () => this.draw(this.asset.levels.length - 1);
    this.mesh.onAfterShadow = () => this.draw(this.level);
    this.mesh.bind(this.skeleton, new Matrix4());
    this.mesh.frustumCulled = false;
    // Any pose fits in this sphere round the pelvis; without it three would skin every vertex on the CPU to sort the scene.
    this.mesh.boundingSphere = this.bounds;
    this.mesh.castShadow = true;
    this.mesh.receiveShadow = true;
  }

  /** Dresses a figure that has its own material, not a ghost. Another style takes another shader, other colours cost nothing. */
  wear(look: Readonly<FigureLook>): void {
    if (look.style === this.look.style) {
      if (look.colours !== this.look.colours) recolour(this.mesh.material as Material, look);
      this.look = look;
      return;
    }
    this.look = look;
    (this.mesh.material as Material).dispose();
    this.mesh.material = createFigureMaterial(look);
    const asset = look.style === 'mannequin' ? mannequin() : this.body;
    if (asset === this.asset) return;
    this.asset = asset;
    this.mesh.geometry.dispose();
    this.mesh.geometry = ownRange(asset.geometry);
    this.draw(this.level);
  }

  /** Level of detail, 0 the finest. */
  set detail(level: number) {
    this.level = Math.min(Math.max(level, 0), this.asset.levels.length - 1);
    this.draw(this.level);
  }

  private draw(level: number): void {
    const { start, count } = this.asset.levels[level];
    this.mesh.geometry.setDrawRange(start, count);
  }

  /** Moves the figure. */
  show(pose: FramePose): void {
    this.pose.set(pose.quaternions, pose.root);
    this.bounds.center.fromArray(this.pose.joints);
    this.skeleton.refresh();
  }

  /** Frees what belongs to this figure. */
  dispose(): void {
    this.skeleton.dispose();
    this.mesh.geometry.dispose();
    const { material } = this.mesh;
    for (const each of Array.isArray(material) ? material : [material]) each.dispose();
  }
}
