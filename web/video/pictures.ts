/** Pictures of a dance that are no videos: a still, a contact sheet of key poses, a small animation. Runs in a worker. */
import { framePose } from '../core/motion';
import { poseToQuaternions } from '../core/rotation';
import { standingRoot } from '../scene/body-points';
import { FilmSet } from '../scene/filming';
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

/** Pictures whose colours are looked at when an animation's are chosen. */
const SAMPLES = 8;
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
  return call.type === 'still' ? still(call.request) : loop(call.request, progress, signal);
}

/** Lets a message to stop be heard. */
async function breathe(signal: AbortSignal): Promise<void> {
  await new Promise((resolve) => setTimeout(resolve, 0));
  signal.throwIfAborted();
}

function take(set: FilmSet, request: SceneRequest, path: CameraPath, frame: number): void {
  const time = frameTime(request.plan, frame);
  set.draw({
    pose: framePose(request.motion, time),
    time,
    position: path.position.subarray(frame * 3, frame * 3 + 3),
    target: path.target.subarray(frame * 3, frame * 3 + 3),
    centre: path.centre.subarray(frame * 2, frame * 2 + 2),
    glow: glowAt(time, request.grid),
  });
}

function pathOf({ motion, plan, width, height, camera, grid, view }: SceneRequest, set: FilmSet): CameraPath {
  const path = cameraPath(motion, plan, width / height, camera, grid, view);
  return fitPath(path, set.dancerSize, camera === 'stage' ? view : null);
}

function setOf({ background, look, avatar }: SceneRequest, canvas: OffscreenCanvas): Promise<FilmSet> {
  return FilmSet.open(canvas, background, FIELD_OF_VIEW, look, avatar);
}

async function still(request: SceneRequest): Promise<Blob> {
  const canvas = new OffscreenCanvas(request.width, request.height);
  const set = await setOf(request, canvas);
  try {
    take(set, request, pathOf(request, set), 0);
    return await canvas.convertToBlob({ type: 'image/png' });
  } finally {
    set.dispose();
  }
}

async function sheet(request: SheetRequest, progress: (done: number) => void, signal: AbortSignal): Promise<Blob> {
  const { poses, scale } = request;
  const layout = sheetLayout(poses.length);
  const edge = Math.max(1, Math.round(layout.figure * scale));
  const canvas = new OffscreenCanvas(edge, edge);
  const page = new OffscreenCanvas(Math.round(layout.width * scale), Math.round(layout.height * scale));
  const brush = page.getContext('2d');
  if (!brush) throw new Error('This browser cannot draw the picture: close other tabs and try again.');
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
  const brush = flat.getContext('2d', { willReadFrequently: true });
  if (!brush) throw new Error('This browser cannot draw the picture: close other tabs and try again.');
  const set = await setOf(request, canvas);
  try {
    const path = pathOf(request, set);
    const pixels = (frame: number) => {
      take(set, request, path, frame);
      brush.drawImage(canvas, 0, 0);
      return brush.getImageData(0, 0, width, height).data;
    };
    const palette = new GifPalette();
    for (let i = 0; i < SAMPLES; i++) {
      palette.count(pixels(Math.floor((i * plan.frames) / SAMPLES)));
      progress((0.15 * i) / SAMPLES);
      await breathe(signal);
    }
    palette.choose(GIF_COLOURS);
    const writer = new GifWriter(width, height, palette.colours, Math.round(100 / plan.fps));
    const indices = new Uint8Array(width * height);
    for (let frame = 0; frame < plan.frames; frame++) {
      const data = pixels(frame);
      for (let i = 0; i < indices.length; i++)
        indices[i] = palette.indexOf(data[i * 4], data[i * 4 + 1], data[i * 4 + 2]);
      writer.add(indices);
      progress(0.15 + (0.85 * (frame + 1)) / plan.frames);
      await breathe(signal);
    }
    return new Blob([writer.finish()], { type: 'image/gif' });
  } finally {
    set.dispose();
  }
}
