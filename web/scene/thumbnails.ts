/** Pictures of poses: the same figure before nothing, drawn by one small renderer in idle time. */
import { NeutralToneMapping, OrthographicCamera, Scene, Vector3, WebGLRenderer } from 'three';
import { DEFAULT_LOOK, type FigureLook } from '../core/figure-look';
import { poseToQuaternions } from '../core/rotation';
import { CAPSULES, placePoint, standingRoot } from './body-points';
import { Figure } from './figure';
import { loadFigure } from './figure-asset';
import { Lights } from './lights';
import { headingOf } from './heading';

/** Draws poses as pictures. */
export interface Thumbnailer {
  /**
   * A transparent PNG of a pose, seen from its front left.
   * @param rotations 24 x 3 axis-angle, radians
   * @param size edge in CSS pixels; the picture has twice as many
   * @param azimuth direction to the camera in the world, radians about Y, 0 = +Z: the same for all figures of a strip; by default the
   * pose's own front left
   * @param look of the figure in this picture; missing: a new project's, whatever the project at hand wears
   * @returns an object URL, which the caller revokes
   */
  render(rotations: ArrayLike<number>, size: number, azimuth?: number, look?: Readonly<FigureLook>): Promise<string>;
  dispose(): void;
}

/** Angle between the pose's own forward direction and the direction to the camera, radians. */
const TURN = 0.5;
const ELEVATION = 0.1;
/** A crouching figure is shown crouching, not blown up to fill the picture: smallest height of the view, metres. */
const SMALLEST_VIEW = 1.72;

interface Job {
  rotations: ArrayLike<number>;
  size: number;
  azimuth?: number;
  look?: Readonly<FigureLook>;
  resolve: (url: string) => void;
  reject: (error: unknown) => void;
}

/**
 * A thumbnailer; its renderer starts with the first picture.
 * @throws (from render) Error when the browser has no WebGL 2 or the thumbnailer is disposed
 */
export function createThumbnailer(): Thumbnailer {
  return new QueuedThumbnailer();
}

class QueuedThumbnailer implements Thumbnailer {
  private readonly queue: Job[] = [];
  private studio: Promise<Studio> | undefined;
  private busy = false;
  private disposed = false;

  render(rotations: ArrayLike<number>, size: number, azimuth?: number, look?: Readonly<FigureLook>): Promise<string> {
    if (this.disposed) return Promise.reject(new Error('The thumbnailer has been closed.'));
    return new Promise((resolve, reject) => {
      this.queue.push({ rotations: Array.from(rotations), size, azimuth, look, resolve, reject });
      void this.work();
    });
  }

  dispose(): void {
    this.disposed = true;
    for (const job of this.queue.splice(0)) job.reject(new Error('The thumbnailer has been closed.'));
    void this.studio?.then((studio) => studio.dispose()).catch(() => undefined);
  }

  private async work(): Promise<void> {
    if (this.busy) return;
    this.busy = true;
    for (let job = this.queue.shift(); job; job = this.queue.shift()) {
      try {
        this.studio ??= Studio.open();
        const studio = await this.studio;
        await idle();
        job.resolve(URL.createObjectURL(await studio.picture(job)));
      } catch (error) {
        job.reject(error);
      }
    }
    this.busy = false;
  }
}

/** Resolves when the page has a moment; soon even if it never has. */
function idle(): Promise<void> {
  return new Promise((resolve) => {
    if (typeof requestIdleCallback === 'function') requestIdleCallback(() => resolve(), { timeout: 120 });
    else setTimeout(resolve, 8);
  });
}

class Studio {
  private readonly scene = new Scene();
  private readonly camera = new OrthographicCamera();
  private readonly lights = new Lights(false);

  private constructor(
    private readonly renderer: WebGLRenderer,
    private readonly figure: Figure,
  ) {
    this.scene.add(figure.mesh, this.lights.group);
  }

  static async open(): Promise<Studio> {
    const asset = await loadFigure();
    const renderer = createRenderer();
    renderer.setClearColor(0, 0);
    renderer.toneMapping = NeutralToneMapping;
    renderer.toneMappingExposure = 1.15;
    renderer.debug.checkShaderErrors = import.meta.env.DEV;
    const studio = new Studio(renderer, new Figure(asset, 1));
    await renderer.compileAsync(studio.scene, studio.camera);
    return studio;
  }

  async picture({ rotations, size, azimuth, look = DEFAULT_LOOK }: Job): Promise<Blob> {
    this.figure.wear(look);
    const quaternions = poseToQuaternions(rotations);
    this.figure.show({ root: standingRoot(quaternions), quaternions });
    this.aim(azimuth ?? headingOf(quaternions) + TURN);
    // Setting even the same size again would throw the picture's buffers away.
    if (this.renderer.domElement.width !== size * 2) this.renderer.setSize(size * 2, size * 2, false);
    this.renderer.render(this.scene, this.camera);
    await this.drawn();
    const canvas = this.renderer.domElement as HTMLCanvasElement | OffscreenCanvas;
    if (canvas instanceof HTMLCanvasElement)
      return new Promise((resolve, reject) =>
        canvas.toBlob((blob) =>
          blob ? resolve(blob) : reject(new Error('The picture of the pose could not be made.')),
        ),
      );
    return canvas.convertToBlob();
  }

  /** Resolves when the picture is drawn; reading it any earlier would hold up the page until it is. */
  private async drawn(): Promise<void> {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (!fence) return;
    gl.flush();
    for (let wait = 0; wait < 500 && gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED; wait++)
      await new Promise((resolve) => setTimeout(resolve, 4));
    gl.deleteSync(fence);
  }

  dispose(): void {
    this.figure.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  /** Turns camera and lights to an azimuth and fits the body into the square. */
  private aim(azimuth: number): void {
    const { joints, rotations } = this.figure.pose;
    const back = new Vector3(
      Math.sin(azimuth) * Math.cos(ELEVATION),
      Math.sin(ELEVATION),
      Math.cos(azimuth) * Math.cos(ELEVATION),
    );
    const right = new Vector3(Math.cos(azimuth), 0, -Math.sin(azimuth));
    const up = back.clone().cross(right);
    const bounds = { left: Infinity, right: -Infinity, bottom: Infinity, top: -Infinity };
    const p = new Vector3();
    for (const { from, to } of CAPSULES)
      for (const end of [from, to]) {
        p.fromArray(placePoint(end, joints, rotations));
        const [x, y] = [p.dot(right), p.dot(up)];
        bounds.left = Math.min(bounds.left, x - end.radius);
        bounds.right = Math.max(bounds.right, x + end.radius);
        bounds.bottom = Math.min(bounds.bottom, y - end.radius);
        bounds.top = Math.max(bounds.top, y + end.radius);
      }
    const half = (Math.max(bounds.right - bounds.left, bounds.top - bounds.bottom, SMALLEST_VIEW) / 2) * 1.05;
    const x = (bounds.left + bounds.right) / 2;
    // A figure lower than the view stands at its bottom, as on a floor.
    const y = Math.max((bounds.bottom + bounds.top) / 2, bounds.bottom + half / 1.05);
    this.camera.position.copy(back).multiplyScalar(6).addScaledVector(right, x).addScaledVector(up, y);
    this.camera.up.copy(up);
    this.camera.lookAt(this.camera.position.clone().sub(back));
    Object.assign(this.camera, { left: -half, right: half, top: half, bottom: -half, near: 0.1, far: 14 });
    this.camera.updateProjectionMatrix();
    this.lights.group.rotation.y = azimuth - TURN;
  }
}

function createRenderer(): WebGLRenderer {
  const options = { antialias: true, alpha: true, preserveDrawingBuffer: true };
  try {
    // The picture of an element waits up to a second for the page to be idle; that of an offscreen canvas does not.
    return new WebGLRenderer({ ...options, canvas: new OffscreenCanvas(128, 128) });
  } catch {
    return new WebGLRenderer(options);
  }
}
