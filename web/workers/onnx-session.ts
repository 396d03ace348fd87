/** A model on one backend: creating it, running a window, checking it against the golden window. */
import type { InferenceSession } from 'onnxruntime-web';
import { spec } from '../core/spec';
import type { WindowInputs } from '../core/windows';
import type { GoldenWindow } from './model-store';
import type { OrtModule } from './onnx-runtime';
import type { Backend } from './protocol';

/** Largest difference to the golden output that rounding can explain; a wrong kernel is off by 0.07 and more. */
export const GOLDEN_TOLERANCE = 0.01;

/** A model that is ready to run. */
export interface DanceSession {
  backend: Backend;
  /** [T, 147] for one window. Rejects when the device is lost or gives numbers that are none. */
  run(inputs: WindowInputs): Promise<Float32Array>;
  close(): Promise<void>;
}

/** Creates a session; the weights are copied by onnxruntime and can be used again. */
export async function openSession(ort: OrtModule, backend: Backend, weights: Uint8Array): Promise<DanceSession> {
  const session = await ort.InferenceSession.create(weights, {
    executionProviders: [backend],
    graphOptimizationLevel: 'all',
    // Windows differ in length: planning memory for one pattern only costs time.
    enableMemPattern: false,
    logSeverityLevel: 3,
  });
  let lost: string | undefined;
  if (backend === 'webgpu') void watchDevice(ort, (reason) => (lost = reason));
  return {
    backend,
    async run(inputs) {
      if (lost) throw new Error(`The graphics processor was lost (${lost}).`);
      const motion = await runSession(ort, session, inputs);
      if (lost) throw new Error(`The graphics processor was lost (${lost}).`);
      if (!motion.every(Number.isFinite)) throw new Error('The model gave numbers that are not finite.');
      return motion;
    },
    close: () => session.release(),
  };
}

interface Device {
  lost: Promise<{ reason?: string; message?: string }>;
}

async function watchDevice(ort: OrtModule, onLost: (reason: string) => void): Promise<void> {
  try {
    const device = (await ort.env.webgpu.device) as unknown as Device;
    const { reason, message } = await device.lost;
    onLost(message || reason || 'unknown reason');
  } catch {
    // A build that does not show its device still rejects the run that fails.
  }
}

async function runSession(ort: OrtModule, session: InferenceSession, inputs: WindowInputs): Promise<Float32Array> {
  const { frames, seedFrames } = inputs;
  const { motionSize, rotationSize } = spec.model;
  const tensor = (data: Float32Array, ...dims: number[]) => new ort.Tensor('float32', data, [1, ...dims]);
  const output = await session.run({
    music: tensor(inputs.music, frames, spec.features.names.length),
    seed: tensor(inputs.seed, seedFrames, motionSize),
    key_poses: tensor(inputs.keyPoses, frames, rotationSize),
    key_mask: tensor(inputs.keyMask, frames),
    to_previous: tensor(inputs.toPrevious, frames),
    to_next: tensor(inputs.toNext, frames),
  });
  return Float32Array.from((await output.motion.getData()) as Float32Array);
}

/** Largest difference between a session's output and the golden window's. */
export async function goldenError(session: DanceSession, golden: GoldenWindow): Promise<number> {
  const motion = await session.run(golden.inputs);
  if (motion.length !== golden.motion.length) return Infinity;
  let largest = 0;
  for (let i = 0; i < motion.length; i++) largest = Math.max(largest, Math.abs(motion[i] - golden.motion[i]));
  return largest;
}
