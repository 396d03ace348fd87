/** A network on one backend, whatever it is for: creating it, running it, checking it against numbers that Python gave. */
import type { InferenceSession } from 'onnxruntime-web';
import type { OrtModule } from './onnx-runtime';
import type { Backend } from './protocol';

/** Numbers for one input of a network, row-major. */
export interface Feed {
  data: Float32Array;
  dims: readonly number[];
}

/** Inputs of a network by their names. */
export type Feeds = Record<string, Feed>;

/** Outputs of a network by their names, row-major. */
export type Outputs = Record<string, Float32Array>;

/** A network that is ready to run. */
export interface Network {
  backend: Backend;
  /** Rejects when the device is lost or gives numbers that are none. */
  run(feeds: Feeds): Promise<Outputs>;
  close(): Promise<void>;
}

/** One run with the outputs that every backend must reproduce. */
export interface GoldenRun {
  feeds: Feeds;
  outputs: Outputs;
}

/** Creates a session; the weights are copied by onnxruntime and can be used again. */
export async function openNetwork(ort: OrtModule, backend: Backend, weights: Uint8Array): Promise<Network> {
  const session = await ort.InferenceSession.create(weights, {
    executionProviders: [backend],
    graphOptimizationLevel: 'all',
    // Runs differ in length: planning memory for one pattern only costs time.
    enableMemPattern: false,
    logSeverityLevel: 3,
  });
  let lost: string | undefined;
  if (backend === 'webgpu') void watchDevice(ort, (reason) => (lost = reason));
  const checkDevice = () => {
    if (lost) throw new Error(`The graphics processor was lost (${lost}).`);
  };
  return {
    backend,
    async run(feeds) {
      checkDevice();
      const outputs = await runSession(ort, session, feeds);
      checkDevice();
      if (!Object.values(outputs).every((numbers) => numbers.every(Number.isFinite)))
        throw new Error('The model gave numbers that are not finite.');
      return outputs;
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

async function runSession(ort: OrtModule, session: InferenceSession, feeds: Feeds): Promise<Outputs> {
  const tensors = Object.entries(feeds).map(([name, { data, dims }]) => [name, new ort.Tensor('float32', data, dims)]);
  const output = await session.run(Object.fromEntries(tensors));
  const numbers: Outputs = {};
  for (const [name, tensor] of Object.entries(output))
    numbers[name] = Float32Array.from((await tensor.getData()) as Float32Array);
  return numbers;
}

/** Largest difference between a network's outputs and the golden ones; Infinity where one is missing or of another size. */
export async function goldenRunError(network: Network, golden: GoldenRun): Promise<number> {
  const outputs = await network.run(golden.feeds);
  let largest = 0;
  for (const [name, wanted] of Object.entries(golden.outputs)) {
    if (outputs[name]?.length !== wanted.length) return Infinity;
    wanted.forEach((value, i) => (largest = Math.max(largest, Math.abs(value - outputs[name][i]))));
  }
  return largest;
}
