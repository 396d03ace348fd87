/** The stage as the rest of the app knows it. */
import type { CameraView } from '../core/document';
import type { FigureLook } from '../core/figure-look';
import type { FramePose, PoseTools } from '../core/types';
import type { AvatarFigure } from './avatar';
import type { Ghost } from './onion';
import type { PathPicture } from './path-picture';
import type { JointHover } from './picker';
import type { PoseListener } from './pose-edit';

/** What the rest of the app does with the stage. Functions that take a listener return how to stop listening. */
export interface Stage {
  readonly canvas: HTMLCanvasElement;
  /** Resolves when the figure is there; rejects when it cannot be loaded. */
  readonly ready: Promise<void>;
  /** Draws a frame of the dance, so many seconds of it after the one before (0 = a jump). In pose mode it is kept for later. */
  show(pose: FramePose, seconds?: number): void;
  /** A character in the place of our figure, in the dance; null = our own. The same one again is drawn anew. */
  setAvatar(avatar: AvatarFigure | null): void;
  /** Draws a frame of another dance beside it, to the left; null = the dance is alone. */
  showBeside(pose: FramePose | null): void;
  /** Dresses our own figure, and the second dancer like it. */
  setLook(look: Readonly<FigureLook>): void;
  /** Calls back before each screen refresh, with performance.now(). */
  beforeFrame(callback: (now: number) => void): () => void;
  setMode(mode: 'dance' | 'pose'): void;
  readonly mode: 'dance' | 'pose';
  /** Pose mode: shows this pose for editing, 24 x 3 axis-angle. Listeners are not told. */
  editPose(rotations: ArrayLike<number>): void;
  onPoseChange(listener: PoseListener): () => void;
  selectJoint(joint: number | null): void;
  onSelect(listener: (joint: number | null) => void): () => void;
  onHover(listener: (hover: JointHover | null) => void): () => void;
  /** Turns the selected joint about one of its own axes; quick repeats make one change. */
  rotateSelected(axis: 'x' | 'y' | 'z', radians: number): void;
  /** Moves the selected joint, metres in the world, the body following; quick repeats make one change. */
  moveSelected(dx: number, dy: number, dz: number): void;
  /** How the gizmo and the dots work: turning or moving, limits, mirroring, pins, the balance hint. */
  setPoseTools(tools: PoseTools): void;
  /** Shows neighbouring key poses as ghosts, at most one of a kind, or none. */
  setGhosts(ghosts: readonly Ghost[] | null): void;
  /** Shows the path of a joint, or none. The picture is copied. */
  setPath(path: PathPicture | null): void;
  /** Calls back when the dancing figure is clicked, with the joint of the limb that was hit. Not in pose mode. */
  onBodyClick(listener: (joint: number) => void): () => void;
  /** Whether the camera goes with the dancer. */
  follow: boolean;
  /** Back to the opening view. */
  frameFigure(): void;
  /** The view as it can be kept: null = the opening view, which fits itself to any screen. */
  getView(): CameraView | null;
  setView(view: CameraView): void;
  /** Tells when the user has turned, zoomed or moved the camera, or asked for the opening view. */
  onView(listener: (view: CameraView | null) => void): () => void;
  /** A glow on the floor that fades by itself; strength 0..1. */
  pulse(strength?: number): void;
  /** Draws per second over the last second, and draw calls of the last one. */
  stats(): { fps: number; drawCalls: number; pixelRatio: number };
  dispose(): void;
}
