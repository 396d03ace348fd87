/** Files from the visitor: chosen, dropped, saved. */
import type { Store } from '../app/store';

export { fileName, saveFile } from '../app/download';

const PROJECT = /\.(posebeat|json)$/i;

/** Opens whatever file it is: a project or a song. */
export function openFile(store: Store, file: File): void {
  if (PROJECT.test(file.name)) void store.openProject(file);
  else void store.dropSong(file);
}

/** Asks for a file. */
export function chooseFile(store: Store, accept = 'audio/*,video/mp4,.m4a,.flac,.ogg,.opus'): void {
  const input = document.createElement('input');
  input.type = 'file';
  input.accept = accept;
  input.addEventListener('change', () => {
    const file = input.files?.[0];
    if (file) openFile(store, file);
  });
  input.click();
}
