/** Files from the visitor: chosen, dropped, saved. */
import { mayBeAvatar } from '../app/avatar-file';
import { isJson, isPoseFile, jsonKindOf } from '../app/pose-reader';
import type { Store } from '../app/store';

export { fileName, saveFile } from '../app/download';

const PROJECT = /\.(posebeat|json|zip)$/i;

/** Opens whatever file it is: a project, a song, a character, poses or a dance. */
export function openFile(store: Store, file: File): void {
  if (mayBeAvatar(file)) void store.openGltf(file, (each) => void store.importPoseFile(each));
  else if (isPoseFile(file)) void store.importPoseFile(file);
  else if (isJson(file)) void openJson(store, file);
  else if (PROJECT.test(file.name)) void store.openProject(file);
  else void store.dropSong(file);
}

/** Opens the first of the files that were dropped together, and says so where there are more. */
export function openDropped(store: Store, files: readonly File[]): void {
  if (files.length === 0) return;
  openFile(store, files[0]);
  if (files.length === 1) return;
  store.notify(
    'info',
    `Of these ${files.length} files only the first, “${files[0].name}”, is read: drop one at a time.`,
  );
}

/** JSON of ours is a project, poses or a dance: what it is stands inside. */
async function openJson(store: Store, file: File): Promise<void> {
  const kind = await jsonKindOf(file).catch(() => null);
  await (kind ? store.importPoseFile(file) : store.openProject(file));
}

/** Asks for a file. */
export function chooseFile(
  store: Store,
  accept = 'audio/*,video/mp4,.m4a,.flac,.ogg,.opus',
  open: (store: Store, file: File) => void = openFile,
): void {
  const input = document.createElement('input');
  input.type = 'file';
  input.accept = accept;
  input.hidden = true;
  // An input outside of the page may be swept away while the chooser is open: its answer would be lost.
  document.body.append(input);
  input.addEventListener('cancel', () => input.remove());
  input.addEventListener('change', () => {
    const file = input.files?.[0];
    input.remove();
    if (file) open(store, file);
  });
  input.click();
}

/** Kinds of project files; some systems know a file by its extension, others by its type. */
const PROJECT_KINDS =
  '.posebeat,.json,.zip,application/x-posebeat,application/json,application/zip,application/octet-stream';

/** Asks for a project file. */
export function chooseProject(store: Store): void {
  chooseFile(store, PROJECT_KINDS, (_, file) => void store.openProject(file));
}
