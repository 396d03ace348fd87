import {
  Bone,
  DataTexture,
  FloatType,
  Matrix4,
  RGBAFormat,
  Skeleton,
  SkinnedMesh,
  Sphere,
  Vector3,
  type BufferGeometry,
} from 'three';
import type { FramePose } from '../core/types';
import { createFigureMaterial } from './figure-material';
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

/** The dancer. Give it poses; add `mesh` to a scene. */
export class Figure {
  readonly mesh: SkinnedMesh;
  /** World positions and rotations of the joints of the last pose. */
  readonly pose = new SkinPose();
  private readonly bounds = new Sphere(new Vector3(), 1.6);
  private readonly skeleton = new FigureSkeleton(this.pose);

  constructor(geometry: BufferGeometry) {
    this.mesh = new SkinnedMesh(geometry, createFigureMaterial());
    this.mesh.bind(this.skeleton, new Matrix4());
    this.mesh.frustumCulled = false;
    // Any pose fits in this sphere round the pelvis; without it three would skin every vertex on the CPU to sort the scene.
    this.mesh.boundingSphere = this.bounds;
    this.mesh.castShadow = true;
    this.mesh.receiveShadow = true;
  }

  /** Moves the figure. */
  show(pose: FramePose): void {
    this.pose.set(pose.quaternions, pose.root);
    this.bounds.center.fromArray(this.pose.joints);
    this.skeleton.refresh();
  }

  /** Frees what belongs to this figure; the geometry is shared and stays. */
  dispose(): void {
    this.skeleton.dispose();
    const { material } = this.mesh;
    for (const each of Array.isArray(material) ? material : [material]) each.dispose();
  }
}
