/** Pictures of a dance that are no videos: a still, a contact sheet of key poses, a small animation. Runs in a worker. */
import { framePose } from '../core/motion';
import { poseToQuaternions } from '../core/rotation';
import { standingRoot } from '../scene/body-points';
import { FilmSet, type Take } from '../scene/filming';
import { headingOf } from '../scene/heading';
import { PALETTE } from '../ui/palette';
import { cameraPath, FIELD_OF_VIEW, type CameraPath } from './camera-path';
import { fitPath } from './dancer-path';
import { GIF_COLOURS, GifWriter } from './gif';
import { GifPalette } from './gif-palette';
import { frameTime } from './options';
import type { PictureCall, SceneRequest, SheetRequest } from './protocol';
import { drawSheet } from './sheet';
import { sheetLayout } from './sheet-layout';
import { glowAt } from './shots';
import { stripRows } from './strips';

/** Pictures whose colours are looked at when an animation's are chosen. */
const SAMPLES = 8;
/** How far a still is when its figure and shaders are there, and when only its file is left to be written. */
const [READY, DRAWN] = [0.1, 0.9];
/** Angle between a key pose's own front and the camera, radians; how high the camera is, and what it looks at, metres. */
const ASIDE = 0.5;
const EYES = { height: 1.35, target: 0.98, away: 4.2 } as const;

/**
 * Makes a picture.
 * @param progress 0..1
 * @throws Error with a message for people; AbortError when the signal fires
 */
export function drawPicture(call: PictureCall, progress: (done: number) => void, signal: AbortSignal): Promise<Blob> {
  if (call.type === 'sheet') return sheet(call.request, progress, signal);
  if (call.type === 'loop') return loop(call.request, progress, signal);
  return still(call.request, call.rows, progress, signal);
}

/** Lets a message to stop be heard. */
async function breathe(signal: AbortSignal): Promise<void> {
  await new Promise((resolve) => setTimeout(resolve, 0));
  signal.throwIfAborted();
}

function brushOf(canvas: OffscreenCanvas, options?: CanvasRenderingContext2DSettings) {
  const brush = canvas.getContext('2d', options);
  if (!brush) throw new Error('This browser cannot draw the picture: close other tabs and try again.');
  return brush;
}

function takeOf(request: SceneRequest, path: CameraPath, frame: number): Take {
  const time = frameTime(request.plan, frame);
  return {
    pose: framePose(request.motion, time),
    time,
    position: path.position.subarray(frame * 3, frame * 3 + 3),
    target: path.target.subarray(frame * 3, frame * 3 + 3),
    centre: path.centre.subarray(frame * 2, frame * 2 + 2),
    glow: glowAt(time, request.grid),
  };
}

function pathOf({ motion, plan, width, height, camera, grid, view }: SceneRequest, set: FilmSet): CameraPath {
  const path = cameraPath(motion, plan, width / height, camera, grid, view);
  return fitPath(path, set.dancerSize, camera === 'stage' ? view : null);
}

function setOf({ background, look, avatar, height }: SceneRequest, canvas: OffscreenCanvas): Promise<FilmSet> {
  return FilmSet.open(canvas, background, FIELD_OF_VIEW, look, avatar, height);
}

/** In strips: without a graphics card a whole one can take long, and would take much memory with either. */
async function still(
  request: SceneRequest,
  rows = stripRows(request.width, request.height),
  progress: (done: number) => void,
  signal: AbortSignal,
): Promise<Blob> {
  const { width, height, background } = request;
  const canvas = new OffscreenCanvas(width, rows);
  const page = new OffscreenCanvas(width, height);
  // Where it is read, each strip is waited for: progress is what has been drawn, not what was asked for.
  const brush = brushOf(page, { alpha: background === 'none', willReadFrequently: true });
  const set = await setOf(request, canvas);
  try {
    progress(READY);
    await breathe(signal);
    set.arrange(takeOf(request, pathOf(request, set), 0));
    for (let top = 0; top < height; top += rows) {
      set.drawStrip(top);
      brush.drawImage(canvas, 0, top);
      progress(READY + (DRAWN - READY) * Math.min(1, (top + rows) / height));
      await breathe(signal);
    }
  } finally {
    set.dispose();
  }
  const blob = await page.convertToBlob({ type: 'image/png' });
  await breathe(signal);
  progress(1);
  return blob;
}

async function sheet(request: SheetRequest, progress: (done: number) => void, signal: AbortSignal): Promise<Blob> {
  const { poses, scale } = request;
  const layout = sheetLayout(poses.length);
  const edge = Math.max(1, Math.round(layout.figure * scale));
  const canvas = new OffscreenCanvas(edge, edge);
  const page = new OffscreenCanvas(Math.round(layout.width * scale), Math.round(layout.height * scale));
  const brush = brushOf(page);
  brush.scale(scale, scale);
  const set = await FilmSet.open(canvas, 'none', FIELD_OF_VIEW, request.look, request.avatar);
  const { size } = set.dancerSize;
  const away = EYES.away * size;
  try {
    const figures = drawSheet(brush, layout, request, PALETTE);
    for (const [i, { rotations }] of poses.entries()) {
      const quaternions = poseToQuaternions(rotations);
      const azimuth = headingOf(quaternions) + ASIDE;
      set.draw({
        pose: { quaternions, root: standingRoot(quaternions) },
        position: [Math.sin(azimuth) * away, EYES.height * size, Math.cos(azimuth) * away],
        target: [0, EYES.target * size, 0],
        centre: [0, 0],
        glow: 0,
      });
      figures(i, canvas);
      progress((i + 1) / poses.length);
      await breathe(signal);
    }
    return await page.convertToBlob({ type: 'image/png' });
  } finally {
    set.dispose();
  }
}

async function loop(request: SceneRequest, progress: (done: number) => void, signal: AbortSignal): Promise<Blob> {
  const { plan, width, height } = request;
  const canvas = new OffscreenCanvas(width, height);
  const flat = new OffscreenCanvas(width, height);
  const brush = brushOf(flat, { willReadFrequently: true });
  const set = await setOf(request, canvas);
  try {
    const path = pathOf(request, set);
    const pixels = (frame: number) => {
      set.draw(takeOf(request, path, frame));
      brush.drawImage(canvas, 0, 0);
      return brush.getImageData(0, 0, width, height).data;
    };
    const palette = new GifPalette();
    const samples = Math.min(SAMPLES, plan.frames);
    for (let i = 0; i < samples; i++) {
      palette.count(pixels(Math.floor((i * plan.frames) / samples)));
      progress((0.15 * (i + 1)) / samples);
      await breathe(signal);
    }
    palette.choose(GIF_COLOURS);
    const writer = new GifWriter(width, height, palette.colours, Math.round(100 / plan.fps));
    const indices = new Uint8Array(width * height);
    for (let frame = 0; frame < plan.frames; frame++) {
      palette.indices(pixels(frame), width, indices);
      writer.add(indices);
      progress(0.15 + (0.85 * (frame + 1)) / plan.frames);
      await breathe(signal);
    }
    return new Blob([writer.finish()], { type: 'image/gif' });
  } finally {
    set.dispose();
  }
}
