/** Messages between the page and the worker that suggests key poses. Every message carries the id of its job. */
import type { SuggestedPose, SuggestRequest } from '../core/suggest';
import type { KeyPose } from '../core/types';
import type { Backend } from './protocol';

/** Which model, and where it runs. */
export interface SuggestModel {
  /** Where the page's own files are. */
  baseUrl: string;
  /** Forces a backend. */
  backend?: Backend;
}

/** What alternates are looked for. */
export type AlternatesRequest = Omit<SuggestRequest, 'density' | 'range' | 'gaps'>;

/** Page -> worker. The model is loaded by the first job that needs it. */
export type SuggestCall =
  /** Only loads the model. */
  | ({ type: 'load'; job: number } & SuggestModel)
  | ({ type: 'suggest'; job: number; request: SuggestRequest } & SuggestModel)
  /** Other poses in the place of a suggested one. */
  | ({ type: 'alternates'; job: number; request: AlternatesRequest; key: KeyPose } & SuggestModel)
  | { type: 'cancel'; job: number };

/** Worker -> page. */
export type SuggestReply =
  | { type: 'loading'; job: number; fraction: number; bytes: number; totalBytes: number; cached: boolean }
  /** Poses that follow those sent before; the share of the beats that is done. */
  | { type: 'poses'; job: number; poses: SuggestedPose[]; fraction: number }
  /** All is done: how it was made. */
  | { type: 'done'; job: number; backend: Backend; model: string; steps: number; milliseconds: number }
  | { type: 'alternates'; job: number; poses: number[][] }
  | { type: 'cancelled'; job: number }
  | { type: 'error'; job: number; message: string };
