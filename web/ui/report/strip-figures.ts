/** Figures for the picture's strips: the stage's own figure, or drawn limbs where the browser has no 3D. */
import { headingOf } from '../../core/localframe';
import { framePose } from '../../core/motion';
import { poseToQuaternions, quaternionsToPose } from '../../core/rotation';
import { forwardKinematics, JOINT_COUNT, jointIndex, JOINTS, PARENTS } from '../../core/skeleton';
import type { Motion } from '../../core/types';
import { PAGE } from './picture-layout';

/** The camera stands a little to the side of where the dancers face, radians. */
const ASIDE = 0.35;
/** Metres that a figure's cell shows, as the thumbnails do. */
const VIEW = 1.8;
const POSE = JOINT_COUNT * 4;
const HEAD = jointIndex('head');

/** Limbs of the two sides are told apart; collars belong to the trunk. */
function limbColour(joint: string): string {
  if (joint.startsWith('left_') && joint !== 'left_collar') return '#6aa5ea';
  return joint.startsWith('right_') && joint !== 'right_collar' ? '#f08672' : '#dde1e8';
}

/** Draws poses as pictures of PAGE.figure pixels. */
export interface FigureArtist {
  draw(rotations: readonly number[], azimuth: number): Promise<CanvasImageSource>;
  dispose(): void;
}

/** Opens the figure renderer. */
export async function createArtist(): Promise<FigureArtist> {
  const { createThumbnailer } = await import('../../scene/thumbnails');
  const thumbnailer = createThumbnailer();
  let flat = false;
  return {
    async draw(rotations, azimuth) {
      if (flat) return drawLimbs(rotations, azimuth);
      try {
        return await picture(await thumbnailer.render(rotations, PAGE.figure / 2, azimuth));
      } catch {
        flat = true; // no 3D here
        return drawLimbs(rotations, azimuth);
      }
    },
    dispose: () => thumbnailer.dispose(),
  };
}

async function picture(url: string): Promise<CanvasImageSource> {
  try {
    const image = new Image();
    image.src = url;
    await image.decode();
    return image;
  } finally {
    URL.revokeObjectURL(url);
  }
}

/** 24 x 3 axis-angle of a dance at a time. */
export function poseAt(motion: Motion, seconds: number): number[] {
  return Array.from(quaternionsToPose(framePose(motion, seconds).quaternions));
}

/** Where the camera stands so that it sees most of a dance from its front: the mean heading, a little aside. */
export function cameraFor(motion: Motion): number {
  let [x, z] = [0, 0];
  for (let t = 0; t < motion.frames; t += 5) {
    const heading = headingOf(motion.quaternions.subarray(t * POSE, t * POSE + 4));
    x += Math.sin(heading);
    z += Math.cos(heading);
  }
  return Math.atan2(x, z) + ASIDE;
}

function drawLimbs(rotations: readonly number[], azimuth: number): CanvasImageSource {
  const size = PAGE.figure;
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = size;
  const brush = canvas.getContext('2d');
  if (!brush) return canvas;
  const joints = forwardKinematics(poseToQuaternions(rotations), [0, 0, 0]);
  const lowest = Math.min(...Array.from({ length: PARENTS.length }, (_, joint) => joints[joint * 3 + 1]));
  const scale = size / VIEW;
  const at = (joint: number) => {
    const across = joints[joint * 3] * Math.cos(azimuth) - joints[joint * 3 + 2] * Math.sin(azimuth);
    return [size / 2 + across * scale, size - 10 - (joints[joint * 3 + 1] - lowest) * scale] as const;
  };
  brush.lineCap = 'round';
  PARENTS.forEach((parent, joint) => {
    if (parent < 0) return;
    brush.lineWidth = joint === HEAD ? 26 : 12;
    brush.strokeStyle = limbColour(JOINTS[joint]);
    brush.beginPath();
    brush.moveTo(...at(parent));
    brush.lineTo(...at(joint));
    brush.stroke();
  });
  return canvas;
}
