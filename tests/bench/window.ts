/** What runs in the page to time one window of the shipped model on the shipped onnxruntime, with nothing else on the page. */
export interface WindowBench {
  ortUrl: string;
  mjsUrl: string;
  wasmUrl: string;
  modelUrl: string;
  backend: 'wasm' | 'webgpu';
  threads: number;
  seedFrames: number;
  musicFrames: number;
  warmUp: number;
  runs: number;
}

/** Times of `runs` windows in milliseconds, after as many as the browser needs to compile hot code in the background. Must not use anything outside its own body. */
export async function timeWindows(bench: WindowBench): Promise<number[]> {
  const ort = await import(/* @vite-ignore */ bench.ortUrl);
  ort.env.wasm.wasmPaths = { mjs: bench.mjsUrl, wasm: bench.wasmUrl };
  ort.env.wasm.numThreads = bench.threads;
  const weights = new Uint8Array(await (await fetch(bench.modelUrl)).arrayBuffer());
  const session = await ort.InferenceSession.create(weights, { executionProviders: [bench.backend] });
  let state = 1;
  const random = () => ((state = (state * 16807) % 2147483647) / 2147483647 - 0.5) * 0.6;
  const tensor = (dims: number[], value: () => number) => {
    const size = dims.reduce((product, each) => product * each, 1);
    return new ort.Tensor('float32', Float32Array.from({ length: size }, value), dims);
  };
  const { seedFrames: s, musicFrames: t } = bench;
  const feeds = {
    music: tensor([1, t, 15], random),
    seed: tensor([1, s, 147], random),
    key_poses: tensor([1, t, 144], random),
    key_mask: tensor([1, t], () => 0),
    to_previous: tensor([1, t], () => -1),
    to_next: tensor([1, t], () => -1),
  };
  const times: number[] = [];
  for (let i = -bench.warmUp; i < bench.runs; i++) {
    const start = performance.now();
    const output = await session.run(feeds);
    await output.motion.getData();
    if (i >= 0) times.push(performance.now() - start);
  }
  await session.release();
  return times;
}
