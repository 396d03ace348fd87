/** Making the picture of two dances, in the background: it goes on while other panels are shown, and can be stopped. */
import { signal } from '@preact/signals';
import { messageOf } from '../../app/context';
import { documentOnStage } from '../../app/on-stage';
import { EXACT_ERROR } from '../../app/report-reference';
import type { Store } from '../../app/store';
import { sliceMotion } from '../../core/motion';
import spec from '../../core/spec.json';
import type { Motion } from '../../core/types';
import { fileName, saveFile } from '../files';
import { drawPicture, type Strip } from './picture';
import { stripTimes, type Stretch } from './picture-layout';
import { cameraFor, createArtist, poseAt, type FigureArtist } from './strip-figures';

/** What is being done; null when nothing is. */
export const pictureJob = signal<{ text: string; fraction: number } | null>(null);

let running: AbortController | null = null;

/** Stops the picture. */
export function cancelPicture(): void {
  running?.abort();
}

/**
 * Makes the picture and offers it as a download; the document and the dance on stage stay as they are.
 * @param clipId - Starting clip of the second dance.
 */
export async function savePicture(store: Store, stretch: Stretch, clipId: string): Promise<void> {
  cancelPicture();
  const own = (running = new AbortController());
  const { signal: stop } = own;
  const tell = (text: string, fraction: number) => {
    if (!stop.aborted) pictureJob.value = { text, fraction };
  };
  const { state } = store;
  const shown = state.onStage.value;
  let artist: FigureArtist | null = null;
  try {
    if (!shown || shown.kind === 'preview') throw new Error('There is no dance yet: generate one first.');
    // All of it is of this moment, whatever the visitor does meanwhile.
    const { song, grid, report, seeds } = state;
    const [music, beats, strength] = [song.value, grid.value, report.value?.consistencyError ?? NaN];
    const keys = shown.inputs?.keyPoses ?? documentOnStage(state).keyPoses;
    const firstClip = shown.inputs?.dials.seedClip ?? documentOnStage(state).dials.seedClip;
    const nameOf = (id: string) => (seeds.value.find((clip) => clip.id === id) ?? seeds.value[0])?.name ?? 'Dance';
    tell('Dancing it another way', 0.02);
    const second = await store.secondDance(stretch, clipId, (done) => tell('Dancing it another way', done * 0.6), stop);
    const frames = [stretch.start, stretch.end].map((time) => Math.floor(time * spec.fps));
    const first = sliceMotion(shown.motion, frames[0], frames[0] + second.frames);
    artist = await createArtist();
    const times = stripTimes(
      stretch,
      keys.map((key) => Math.round(key.time * spec.fps) / spec.fps),
    );
    const camera = cameraFor(first);
    const strips: Strip[] = [];
    const dances: [Motion, string, string][] = [
      [first, nameOf(firstClip), 'the dance on stage'],
      [second, nameOf(clipId), 'another starting clip'],
    ];
    for (const [motion, name, note] of dances) {
      const figures: Strip['figures'] = [];
      for (const { time, key } of times) {
        stop.throwIfAborted();
        tell('Drawing figures', 0.6 + (0.38 * (strips.length * times.length + figures.length)) / (2 * times.length));
        const image = await artist.draw(poseAt(motion, time - frames[0] / spec.fps), camera);
        figures.push({ time, key, image });
      }
      strips.push({ name, note, figures });
    }
    stop.throwIfAborted();
    const canvas = drawPicture({
      title: (music?.reference.name ?? 'Dance').replace(/\.[a-z0-9]{2,5}$/i, ''),
      range: stretch,
      tempo: beats?.tempo ?? null,
      grid: beats,
      waveform: music?.waveform ?? null,
      features: music?.features ?? null,
      strips,
      exact: strength < EXACT_ERROR,
    });
    const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, 'image/png'));
    if (!blob) throw new Error('The picture could not be made: close other tabs and try again.');
    stop.throwIfAborted();
    saveFile(blob, fileName(`${music?.reference.name ?? 'dance'}`, 'png').replace(/\.png$/, ' in two dances.png'));
  } catch (error) {
    if (!stop.aborted) store.notify('error', messageOf(error));
  } finally {
    artist?.dispose();
    if (running === own) {
      running = null;
      pictureJob.value = null;
    }
  }
}
