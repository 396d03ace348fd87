import { Group, type Object3D } from 'three';
import { DEFAULT_LOOK, type FigureLook } from '../core/figure-look';
import { JOINT_COUNT } from '../core/skeleton';
import type { FramePose } from '../core/types';
import type { AvatarFigure } from './avatar';
import { AvatarPlace } from './avatar-place';
import { APART, aside, Beside } from './beside';
import { Figure } from './figure';
import { loadFigure, type FigureAsset } from './figure-asset';
import { REST_HEIGHT } from './rest';

/** Who is on the stage: our figure, or a character in its place, and at times a second dancer beside it. */
export class Dancers {
  readonly group = new Group();
  /** Ours, as soon as it is there; poses are edited on it. */
  figure: Figure | null = null;
  /** What our figures are made of, as soon as it is there. */
  asset: FigureAsset | null = null;
  private readonly place: AvatarPlace;
  private readonly beside = new Beside();
  /** The frame of the dance that is shown, or kept while a pose is edited. */
  private readonly frame: { root: Float32Array; quaternions: Float32Array };
  private look: Readonly<FigureLook> = DEFAULT_LOOK;
  private disposed = false;

  /** @param compile builds the shaders of an object beside the page's own work */
  constructor(compile: (object: Object3D) => Promise<unknown>) {
    this.frame = { root: new Float32Array([0, REST_HEIGHT, 0]), quaternions: new Float32Array(JOINT_COUNT * 4) };
    for (let joint = 0; joint < JOINT_COUNT; joint++) this.frame.quaternions[joint * 4 + 3] = 1;
    this.place = new AvatarPlace(compile);
    this.group.add(this.beside.group, this.place.group);
  }

  /** Whom the dance is danced by: a character, or our figure. */
  get lead(): AvatarFigure | Figure | null {
    return this.place.avatar ?? this.figure;
  }

  /** How far the two dances are apart, metres; 0 while there is only one. */
  get apart(): number {
    return this.beside.root ? 2 * APART : 0;
  }

  /**
   * Brings our figure.
   * @param compile builds the shaders of all that is on the stage; the figure is among it by then
   * @returns whether it came: false when the stage was closed meanwhile
   * @throws Error when the figure cannot be fetched
   */
  async load(compile: () => Promise<unknown>): Promise<boolean> {
    const asset = await loadFigure();
    if (this.disposed) return false;
    const figure = new Figure(asset);
    figure.wear(this.look);
    this.group.add(figure.mesh);
    figure.show(this.frame);
    await compile();
    if (this.disposed) {
      figure.dispose();
      return false;
    }
    this.figure = figure;
    this.asset = asset;
    return true;
  }

  /** A character in the place of our figure; null = our own. `changed` is called when somebody came, went or changed. */
  setAvatar(avatar: AvatarFigure | null, changed: () => void): void {
    this.place.set(avatar, this.frame, changed);
  }

  /** A frame of another dance beside this one; null = none. */
  setBeside(pose: FramePose | null): void {
    this.beside.set(this.asset, pose);
  }

  /** Dresses our own figure, and the second dancer like it. */
  wear(look: Readonly<FigureLook>): void {
    this.look = look;
    this.figure?.wear(look);
    this.beside.wear(look);
  }

  /** Keeps a frame of the dance, for {@link dance}. The pose is copied. */
  keep(pose: FramePose): void {
    this.frame.root.set(pose.root);
    this.frame.quaternions.set(pose.quaternions);
  }

  /**
   * Shows the frame that was kept last.
   * @param seconds of the dance since the one before; 0 = a jump
   * @returns where it is danced, x and z in metres: the middle, where there are two
   */
  dance(seconds: number): [number, number] {
    const stride = this.place.avatar?.stride ?? 1;
    const [x, z] = [this.frame.root[0] * stride, this.frame.root[2] * stride];
    const other = this.beside.root;
    this.figure?.show(other ? aside(this.frame, APART) : this.frame);
    this.place.group.position.x = other ? APART : 0;
    this.place.avatar?.show(this.frame, seconds);
    return other ? [(x + other[0]) / 2, (z + other[1]) / 2] : [x, z];
  }

  /**
   * Either our figure or a character is to be seen. Poses are edited on our figure.
   * @returns how large the one to be seen is and how far it goes for a metre of the dance, beside our figure
   */
  cast(dancing: boolean): { size: number; stride: number } {
    const avatar = dancing ? this.place.avatar : null;
    this.place.group.visible = avatar !== null;
    if (this.figure) this.figure.mesh.visible = avatar === null;
    return { size: avatar?.size ?? 1, stride: avatar?.stride ?? 1 };
  }

  /** Frees our figures; a character belongs to whoever made it. */
  dispose(): void {
    this.disposed = true;
    this.place.dispose();
    this.beside.dispose();
    this.figure?.dispose();
  }
}
