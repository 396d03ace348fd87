/** The dance model on one backend: running a window, checking it against the golden window. */
import { spec } from '../core/spec';
import type { WindowInputs } from '../core/windows';
import type { GoldenWindow } from './model-store';
import { openNetwork, type Feeds } from './onnx-network';
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
  const network = await openNetwork(ort, backend, weights);
  return {
    backend,
    run: async (inputs) => (await network.run(windowFeeds(inputs))).motion,
    close: () => network.close(),
  };
}

function windowFeeds({ frames, seedFrames, ...inputs }: WindowInputs): Feeds {
  const { motionSize, rotationSize } = spec.model;
  return {
    music: { data: inputs.music, dims: [1, frames, spec.features.names.length] },
    seed: { data: inputs.seed, dims: [1, seedFrames, motionSize] },
    key_poses: { data: inputs.keyPoses, dims: [1, frames, rotationSize] },
    key_mask: { data: inputs.keyMask, dims: [1, frames] },
    to_previous: { data: inputs.toPrevious, dims: [1, frames] },
    to_next: { data: inputs.toNext, dims: [1, frames] },
  };
}

/** Largest difference between a session's output and the golden window's. */
export async function goldenError(session: DanceSession, golden: GoldenWindow): Promise<number> {
  const motion = await session.run(golden.inputs);
  if (motion.length !== golden.motion.length) return Infinity;
  let largest = 0;
  for (let i = 0; i < motion.length; i++) largest = Math.max(largest, Math.abs(motion[i] - golden.motion[i]));
  return largest;
}
