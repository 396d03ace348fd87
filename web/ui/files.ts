/** Files from the visitor: chosen, dropped, saved. */
import type { Store } from '../app/store';

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

/** Offers a blob as a download. */
export function saveFile(blob: Blob, name: string): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** A file's name without what file systems dislike. */
export function fileName(title: string, extension: string): string {
  const plain = title
    .replace(/\.[a-z0-9]{2,5}$/i, '')
    .replace(/[^\p{L}\p{N} _-]/gu, '')
    .trim();
  return `${plain || 'dance'}.${extension}`;
}
