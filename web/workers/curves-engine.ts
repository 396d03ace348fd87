/** The curves model (paper B, stage 2) on the best backend that works here. */
import { CHANNELS } from '../core/curves';
import { CURVE_SIZE, MOMENTS, type IntervalInputs, type IntervalOutputs } from '../core/curves-dance';
import { FRAME_FEATURE_SIZE } from '../core/beat-features';
import { JOINT_COUNT } from '../core/skeleton';
import { ModelEngine, networkKind, type EngineOptions, type EngineState } from './onnx-engine';
import type { Feeds, Outputs } from './onnx-network';

/** public/models/curves.json names its files; it is loaded only when a dance of curves is asked for. */
export const CURVES_KIND = networkKind('curves', 'The curves model');

/** The network's inputs by their names. */
export function intervalFeeds({ intervals, keys, keyMask, seconds, music }: IntervalInputs): Feeds {
  return {
    keys: { data: keys, dims: [intervals, 4, JOINT_COUNT, 4] },
    key_mask: { data: keyMask, dims: [intervals, 2] },
    seconds: { data: seconds, dims: [intervals, 3] },
    music: { data: music, dims: [intervals, MOMENTS, FRAME_FEATURE_SIZE] },
  };
}

/**
 * The network's outputs; their sizes are checked.
 * @throws Error where the model is another one
 */
export function intervalOutputs({ curves, root }: Outputs, intervals: number): IntervalOutputs {
  if (curves?.length !== intervals * CHANNELS * CURVE_SIZE || root?.length !== intervals * 6) {
    throw new Error('The curves model gives numbers of another size: reload the page.');
  }
  return { curves, root };
}

/** The curves model, loaded. */
export interface CurveEngine {
  readonly state: EngineState;
  run(inputs: IntervalInputs): Promise<IntervalOutputs>;
  close(): Promise<void>;
}

/** Opens the curves model. */
export const CurveEngine = {
  async open(options: EngineOptions, onChange?: (state: EngineState) => void): Promise<CurveEngine> {
    const engine = await ModelEngine.open(CURVES_KIND, options, onChange);
    return {
      state: engine.state,
      run: async (inputs) => intervalOutputs(await engine.run(intervalFeeds(inputs)), inputs.intervals),
      close: () => engine.close(),
    };
  },
};
