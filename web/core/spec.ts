/** Typed access to spec.json, the one contract between the page, its workers and the Python side. */
import json from './spec.json';
import { sha256Hex } from './spec-hash';

type Triple = readonly [number, number, number];

interface Foot {
  readonly ankle: number;
  readonly toe: number;
}

/** The contract's shape; see spec.json. */
export interface Spec {
  readonly version: number;
  readonly fps: number;
  readonly skeleton: {
    readonly joints: readonly string[];
    readonly parents: readonly number[];
    /** Rest offsets from the parent joint, metres. */
    readonly offsets: readonly Triple[];
    /** Height of a standing figure's toe joints above the floor, metres. */
    readonly toeHeight: number;
    readonly feet: { readonly left: Foot; readonly right: Foot };
  };
  readonly features: {
    readonly names: readonly string[];
    readonly sampleRate: number;
    readonly hop: number;
    readonly fftSize: number;
  };
  readonly model: {
    readonly seedFrames: number;
    readonly musicFrames: number;
    readonly overlapFrames: number;
    readonly maxFrames: number;
    readonly rotationSize: number;
    readonly motionSize: number;
    readonly motionOrder: string;
  };
  /** DanceFormer: what its two networks hear, and how their windows and curves are cut. */
  readonly danceformer: {
    /** Music per frame. */
    readonly featureNames: readonly string[];
    /** What stands behind those in the music of a beat. */
    readonly beatExtraNames: readonly string[];
    /** Width of the Hamming window around a beat. */
    readonly beatWindowSeconds: number;
    /** Frames on either side of a beat in which its loudest onset is looked for. */
    readonly onsetPeakFrames: number;
    readonly styles: readonly string[];
    readonly suggest: {
      readonly pastPoses: number;
      readonly pastBeats: number;
      readonly futureBeats: number;
      readonly codes: number;
      readonly farthestFixedBeats: number;
    };
    readonly curve: {
      readonly intervalSteps: number;
      readonly innerFractions: readonly [number, number];
      readonly values: readonly string[];
    };
  };
}

/** The contract itself. */
export const spec: Spec = json as unknown as Spec;

/** JSON with the keys of every object sorted and no spaces: the same text as Python's `json.dumps(sort_keys=True, separators=(',', ':'))`. */
export function canonicalJson(value: unknown): string {
  if (Array.isArray(value)) return `[${value.map(canonicalJson).join(',')}]`;
  if (value && typeof value === 'object') {
    const members = Object.entries(value).sort(([a], [b]) => (a < b ? -1 : a > b ? 1 : 0));
    return `{${members.map(([key, member]) => `${JSON.stringify(key)}:${canonicalJson(member)}`).join(',')}}`;
  }
  return JSON.stringify(value);
}

/** Fingerprint of the contract: a model made for another one must not be used. */
export const specHash: string = sha256Hex(canonicalJson(json));
