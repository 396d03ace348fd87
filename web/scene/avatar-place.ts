import { Group, type Object3D } from 'three';
import type { FramePose } from '../core/types';
import type { AvatarFigure } from './avatar';

/** The place of a character on the stage. It stays empty until the character's shaders are there. */
export class AvatarPlace {
  readonly group = new Group();
  /** Who is to be seen; null = nobody, or not yet. */
  avatar: AvatarFigure | null = null;
  private wanted: AvatarFigure | null = null;

  /** @param compile builds the shaders of an object beside the page's own work */
  constructor(private readonly compile: (object: Object3D) => Promise<unknown>) {}

  /**
   * Puts a character here in place of the one before; null = nobody.
   * @param pose what it stands in when it comes
   * @param changed called when somebody came or went, or the same one has changed
   */
  set(avatar: AvatarFigure | null, pose: FramePose, changed: () => void): void {
    if (avatar === this.wanted) {
      if (avatar === this.avatar) changed();
      return;
    }
    this.wanted = avatar;
    this.avatar?.object.removeFromParent();
    this.avatar = null;
    changed();
    if (!avatar) return;
    avatar.show(pose);
    const come = () => {
      if (this.wanted !== avatar) return;
      this.avatar = avatar;
      this.group.add(avatar.object);
      changed();
    };
    // A shader that could not be built beforehand is built when it is drawn.
    this.compile(avatar.object).then(come, come);
  }

  /** Empties the place; the character belongs to whoever made it. */
  dispose(): void {
    this.wanted = null;
    this.avatar?.object.removeFromParent();
    this.avatar = null;
  }
}
