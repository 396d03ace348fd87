import { useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { openDropped } from './files';
import { Icon } from './Icon';
import { useStore } from './store-context';

/** Anywhere on the page is a place to drop a song, a character or whatever else can be opened. */
export function DropOverlay() {
  const store = useStore();
  const over = useSignal(false);

  useEffect(() => {
    const hasFile = (event: DragEvent) => event.dataTransfer?.types.includes('Files') ?? false;
    const onOver = (event: DragEvent) => {
      if (!hasFile(event)) return;
      event.preventDefault();
      over.value = true;
    };
    const onLeave = (event: DragEvent) => {
      if (event.relatedTarget === null) over.value = false;
    };
    const onDrop = (event: DragEvent) => {
      if (!hasFile(event)) return;
      event.preventDefault();
      over.value = false;
      openDropped(store, [...(event.dataTransfer?.files ?? [])]);
    };
    window.addEventListener('dragover', onOver);
    window.addEventListener('dragleave', onLeave);
    window.addEventListener('drop', onDrop);
    return () => {
      window.removeEventListener('dragover', onOver);
      window.removeEventListener('dragleave', onLeave);
      window.removeEventListener('drop', onDrop);
    };
  }, [store, over]);

  if (!over.value) return null;
  return (
    <div class="drop-overlay" aria-hidden="true">
      <Icon name="music" size={48} />
      <strong>Let go to dance with it</strong>
      <small>A song, a character, a motion or a project</small>
    </div>
  );
}
