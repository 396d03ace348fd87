/** From a file to decoded sound, with a clear message for everything that is no song. */
import { sniffSound, type SoundFormat } from '../core/sound-format';

/** Longest and shortest song, seconds. */
const MAX_SECONDS = 30 * 60;
const MIN_SECONDS = 1;
/** Loudest sample of a song that counts as silent: -80 dB. */
const SILENCE = 1e-4;
/** Samples looked at before the page gets its turn. */
const SCAN_SAMPLES = 1 << 20;
/** A flac whose sound ends this far before its header says so is cut short. */
const TRUNCATED_SHARE = 0.98;

/** Why a file cannot be danced to. */
export type SongErrorCode =
  'empty' | 'not-audio' | 'unsupported' | 'protected' | 'truncated' | 'silent' | 'too-short' | 'too-long';

/** A file that is no usable song; the message is for people. */
export class SongError extends Error {
  override readonly name = 'SongError';
  constructor(
    readonly code: SongErrorCode,
    message: string,
  ) {
    super(message);
  }
}

/** Lets the page draw and answer before the next piece of work. */
export function yieldToPage(): Promise<void> {
  return new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      resolve();
    };
    port2.postMessage(0);
  });
}

/**
 * Decodes a song at its own sample rate where its header tells it.
 * @param source an ArrayBuffer is emptied (decoding takes it over)
 * @param signal stops between steps with an AbortError
 * @throws SongError when this is no usable song
 */
export async function decodeSong(source: Blob | ArrayBuffer, signal?: AbortSignal): Promise<AudioBuffer> {
  const bytes = source instanceof ArrayBuffer ? source : await source.arrayBuffer();
  signal?.throwIfAborted();
  const size = bytes.byteLength;
  if (size === 0) throw new SongError('empty', 'This file is empty. Choose another one, or export it again.');
  const format = sniffSound(new Uint8Array(bytes));
  rejectByHeader(format);
  const buffer = await decode(bytes, format);
  signal?.throwIfAborted();
  await rejectBySound(buffer, format, signal);
  return buffer;
}

function rejectByHeader(format: SoundFormat): void {
  if (format.isProtected) {
    throw new SongError(
      'protected',
      'This song is copy-protected, so the browser may not decode it. Use a version without protection (mp3, wav, flac, ogg, m4a).',
    );
  }
  if (format.kind === null && format.other) {
    throw new SongError('not-audio', `This is ${format.other}. Drop a song: mp3, wav, flac, ogg or m4a.`);
  }
  if (format.isTruncated) throw truncated();
  if (format.duration !== undefined && format.duration > MAX_SECONDS) throw tooLong(format.duration);
}

function truncated(): SongError {
  return new SongError(
    'truncated',
    'This file ends too early: a part of the song is missing. Download or export it again.',
  );
}

function tooLong(seconds: number): SongError {
  const minutes = Math.round(seconds / 60);
  return new SongError(
    'too-long',
    `This song lasts ${minutes} minutes; up to ${MAX_SECONDS / 60} are possible. Cut it shorter first.`,
  );
}

async function decode(bytes: ArrayBuffer, format: SoundFormat): Promise<AudioBuffer> {
  try {
    return await contextFor(format.sampleRate).decodeAudioData(bytes);
  } catch (cause) {
    if ((cause as Error | null)?.name === 'AbortError') throw cause;
    throw format.kind === null
      ? new SongError('not-audio', 'This is not a sound file. Drop a song: mp3, wav, flac, ogg or m4a.')
      : new SongError(
          'unsupported',
          `This browser cannot decode this ${format.kind} file: it is damaged or of an unusual kind. Export it as mp3 or wav and try again.`,
        );
  }
}

/** decodeAudioData resamples to its context's rate; one at the song's own rate leaves the sound as it is. */
function contextFor(sampleRate = 44100): BaseAudioContext {
  try {
    return new OfflineAudioContext(1, 1, sampleRate);
  } catch {
    return new OfflineAudioContext(1, 1, 44100);
  }
}

async function rejectBySound(buffer: AudioBuffer, format: SoundFormat, signal?: AbortSignal): Promise<void> {
  const { duration } = buffer;
  const isCutFlac =
    format.kind === 'flac' && format.duration !== undefined && duration < TRUNCATED_SHARE * format.duration;
  if (isCutFlac) throw truncated();
  if (duration < MIN_SECONDS) {
    throw new SongError(
      'too-short',
      `This sound lasts ${duration.toFixed(1)} seconds. A dance needs at least ${MIN_SECONDS} second of music.`,
    );
  }
  if (duration > MAX_SECONDS) throw tooLong(duration);
  if (await isSilent(buffer, signal)) {
    throw new SongError('silent', 'There is only silence in this file. Check it in a player, or choose another song.');
  }
}

async function isSilent(buffer: AudioBuffer, signal?: AbortSignal): Promise<boolean> {
  for (let c = 0; c < buffer.numberOfChannels; c++) {
    const samples = buffer.getChannelData(c);
    for (let from = 0; from < samples.length; from += SCAN_SAMPLES) {
      const end = Math.min(samples.length, from + SCAN_SAMPLES);
      for (let i = from; i < end; i++) if (Math.abs(samples[i]) > SILENCE) return false;
      await yieldToPage();
      signal?.throwIfAborted();
    }
  }
  return true;
}

/**
 * Mean of the channels of a part of a song.
 * @returns end - from samples
 */
export function monoPart(buffer: AudioBuffer, from: number, end: number): Float32Array<ArrayBuffer> {
  const mono = new Float32Array(end - from);
  const { numberOfChannels } = buffer;
  buffer.copyFromChannel(mono, 0, from);
  if (numberOfChannels === 1) return mono;
  for (let c = 1; c < numberOfChannels; c++) {
    const channel = buffer.getChannelData(c);
    for (let i = 0; i < mono.length; i++) mono[i] += channel[from + i];
  }
  for (let i = 0; i < mono.length; i++) mono[i] /= numberOfChannels;
  return mono;
}
