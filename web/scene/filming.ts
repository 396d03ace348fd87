/** A stage without a visitor: figure, floor and light drawn into a canvas of its own, one picture per call. */
import { Color, PerspectiveCamera, Scene, WebGLRenderer } from 'three';
import { DEFAULT_LOOK, type FigureLook } from '../core/figure-look';
import type { FramePose } from '../core/types';
import type { AvatarFigure, AvatarSource } from './avatar';
import { Figure } from './figure';
import { loadFigure } from './figure-asset';
import { applyLook } from './filming-look';
import { Surroundings } from './surroundings';

/** One picture. */
export interface Take {
  pose: FramePose;
  /** Seconds; a character's hair and skirts swing on from the picture before. */
  time?: number;
  /** Where the camera is and what it looks at, metres. */
  position: ArrayLike<number>;
  target: ArrayLike<number>;
  /** Middle of the light on the floor: x and z, metres. */
  centre: ArrayLike<number>;
  /** The floor's glow, 0..1. */
  glow: number;
}

/** Figure, floor, lamps and a camera; made of the same parts as the stage. */
export class FilmSet {
  private readonly scene = new Scene();
  private readonly surroundings: Surroundings;
  private readonly camera: PerspectiveCamera;
  private before = NaN;

  private constructor(
    private readonly renderer: WebGLRenderer,
    private readonly dancer: Figure | AvatarFigure,
    private readonly picture: { width: number; height: number },
    fieldOfView: number,
    onStage: boolean,
  ) {
    this.camera = new PerspectiveCamera(fieldOfView, picture.width / picture.height, 0.05, 120);
    // Once for a picture, however many strips it has.
    renderer.shadowMap.autoUpdate = false;
    this.surroundings = new Surroundings(onStage);
    this.surroundings.fit(this.dancerSize.size);
    this.scene.add('mesh' in dancer ? dancer.mesh : dancer.object, this.surroundings.group);
  }

  /**
   * Builds the set.
   * @param canvas of the picture's size in pixels, or of the size of its strips
   * @param background `stage`, `none`, or a colour as `#rrggbb`, which the picture has exactly
   * @param fieldOfView vertical, degrees
   * @param look of the figure
   * @param avatar dances in the figure's place
   * @param whole the picture's height in pixels, where the canvas holds a strip of it
   * @throws Error when the browser has no WebGL 2 or the figure cannot be loaded
   */
  static async open(
    canvas: OffscreenCanvas,
    background: string,
    fieldOfView: number,
    look: Readonly<FigureLook> = DEFAULT_LOOK,
    avatar?: AvatarSource,
    whole = canvas.height,
  ): Promise<FilmSet> {
    const { width, height } = canvas;
    const renderer = createRenderer(canvas, background === 'none');
    renderer.setSize(width, height, false);
    const onStage = background === 'stage';
    const dancer = avatar ? await (await import('./avatar')).openAvatar(avatar) : await dressed(look);
    const set = new FilmSet(renderer, dancer, { width, height: whole }, fieldOfView, onStage);
    if (background.startsWith('#')) set.scene.background = new Color(background);
    await renderer.compileAsync(set.scene, set.camera);
    return set;
  }

  /** How large the dancer is and how far it goes for a metre of the dance, beside our figure. */
  get dancerSize(): { size: number; stride: number } {
    return 'size' in this.dancer ? this.dancer : { size: 1, stride: 1 };
  }

  /**
   * Draws one picture into the canvas; it is there until the script yields.
   * @throws Error when the graphics card was taken away
   */
  draw(take: Take): void {
    this.arrange(take);
    this.drawStrip(0);
  }

  /** Puts everything in its place for {@link drawStrip}. */
  arrange({ pose, time = NaN, position, target, centre, glow }: Take): void {
    this.dancer.show(pose, time - this.before || 0);
    this.before = time;
    this.camera.position.fromArray(Array.from(position));
    this.camera.lookAt(target[0], target[1], target[2]);
    this.surroundings.arrange(centre[0], centre[1], this.camera, this.dancer.pose.joints);
    this.surroundings.shine(glow);
    this.renderer.shadowMap.needsUpdate = true;
  }

  /**
   * Draws as many rows of the picture as the canvas has; they are there until the script yields.
   * @param top row of the picture that is the canvas's first
   * @throws Error when the graphics card was taken away
   */
  drawStrip(top: number): void {
    if (this.renderer.getContext().isContextLost()) {
      throw new Error(
        'The graphics card was needed elsewhere: close other 3D pages, choose a smaller size, try again.',
      );
    }
    // The camera sees all of the picture, whatever part is drawn: outlines a pixel wide stay as they are. Rows count from below here.
    const { width, height } = this.picture;
    this.renderer.setViewport(0, top + this.renderer.domElement.height - height, width, height);
    this.renderer.render(this.scene, this.camera);
  }

  /** Frees everything. */
  dispose(): void {
    this.dancer.dispose();
    this.surroundings.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }
}

async function dressed(look: Readonly<FigureLook>): Promise<Figure> {
  const figure = new Figure(await loadFigure());
  figure.wear(look);
  return figure;
}

function createRenderer(canvas: OffscreenCanvas, alpha: boolean): WebGLRenderer {
  let renderer: WebGLRenderer;
  try {
    renderer = new WebGLRenderer({ canvas, alpha, antialias: true, powerPreference: 'high-performance' });
  } catch {
    throw new Error('This browser cannot draw 3D here (WebGL 2 is off): turn on hardware acceleration and try again.');
  }
  applyLook(renderer);
  if (alpha) renderer.setClearColor(0, 0);
  return renderer;
}
