/** The worker that suggests key poses, seen from the app, and what the page shows of it. */
import { signal } from '@preact/signals';
import type { Density, SuggestRequest } from '../core/suggest';
import type { KeyPose } from '../core/types';
import type { Backend } from '../workers/protocol';
import type { SuggestClient, SuggestFollow, SuggestResult } from '../workers/suggest-client';
import type { AlternatesRequest } from '../workers/suggest-protocol';

export type { SuggestResult } from '../workers/suggest-client';

/** Suggests key poses; the model is loaded when it is first used. */
export interface Suggester {
  /** Loads the model ahead of its first use. */
  load(backend?: Backend): Promise<void>;
  /** Rejects with an AbortError when the follow's signal fires. */
  suggest(request: SuggestRequest, follow: SuggestFollow, backend?: Backend): Promise<SuggestResult>;
  /** Other poses for a suggested one. */
  alternates(request: AlternatesRequest, key: KeyPose, signal?: AbortSignal, backend?: Backend): Promise<number[][]>;
}

/** Where poses are suggested: all that is danced, the selected range, or between the visitor's own key poses. */
export type SuggestPlace = 'all' | 'range' | 'gaps';

/** What the visitor chose in the menu. */
export interface SuggestChoice {
  density: Density;
  place: SuggestPlace;
  /** 0..1. */
  variation: number;
  /** One of the model's styles; null = any. */
  style: string | null;
}

/** What the suggester is doing. */
export type Suggestion =
  | { status: 'idle' }
  /** Share of the model that is here. */
  | { status: 'loading'; fraction: number }
  /** Share of the beats that is done, and the poses so far. */
  | { status: 'running'; fraction: number; poses: number };

/** Poses that a suggested key pose can have: the one that was suggested first. */
export type Alternates = ReadonlyMap<string, readonly (readonly number[])[]>;

/** The signals of the suggestions. */
export function createSuggestState() {
  return {
    /** What the suggester is doing. */
    suggestion: signal<Suggestion>({ status: 'idle' }),
    suggestChoice: signal<SuggestChoice>({ density: 'half', place: 'all', variation: 0.5, style: null }),
    /** By the id of the key pose, as far as they are known. */
    alternates: signal<Alternates>(new Map()),
  };
}

/** The worker behind the app's own port, started only when poses are wanted. */
export function createSuggester(): Suggester {
  let client: Promise<SuggestClient> | null = null;
  const open = () => {
    client ??= import('../workers/suggest-client').then(({ SuggestClient }) => new SuggestClient());
    return client;
  };
  const model = (backend?: Backend) => ({ baseUrl: document.baseURI, backend });
  return {
    load: async (backend) => (await open()).load(model(backend)),
    suggest: async (request, follow, backend) => (await open()).suggest(model(backend), request, follow),
    alternates: async (request, key, signal, backend) =>
      (await open()).alternates(model(backend), request, key, signal),
  };
}
