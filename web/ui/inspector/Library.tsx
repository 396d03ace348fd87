import { useComputed, useSignal } from '@preact/signals';
import type { LibraryPose } from '../../core/types';
import { Icon } from '../Icon';
import { flyToLane, startPoseDrag } from '../pose-drag';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';
import { PosePicture } from '../thumbs';

const STANDING = new Array<number>(72).fill(0);

/** The poses to place, by group, with search; above them what is selected on the timeline. */
export function Library() {
  const store = useStore();
  const { poses } = store.state;
  const query = useSignal('');
  const group = useSignal<string | null>(null);
  const groups = useComputed(() => [...new Set(poses.value.map((pose) => pose.group))]);
  const shown = useComputed(() => {
    const words = query.value.toLowerCase().split(/\s+/).filter(Boolean);
    return poses.value.filter((pose) => {
      const text = `${pose.name} ${pose.group}`.toLowerCase();
      return (group.value === null || pose.group === group.value) && words.every((word) => text.includes(word));
    });
  });

  return (
    <>
      <Selected />
      <div class="pose-actions">
        <button type="button" class="secondary" onClick={() => store.editPose(STANDING)}>
          <Icon name="person" />
          New pose
        </button>
        <button type="button" class="secondary" onClick={() => store.keepPoseHere()} title={tip('add')}>
          <Icon name="pin" />
          From dance
        </button>
      </div>
      <div class="find">
        <label class="search">
          <Icon name="search" size={16} />
          <span class="visually-hidden">Search poses</span>
          <input
            type="search"
            placeholder="Search"
            value={query.value}
            onInput={(event) => (query.value = event.currentTarget.value)}
          />
        </label>
        <select
          aria-label="Group"
          value={group.value ?? ''}
          onChange={(event) => (group.value = event.currentTarget.value || null)}
        >
          <option value="">All styles</option>
          {groups.value.map((name) => (
            <option key={name} value={name}>
              {name}
            </option>
          ))}
        </select>
      </div>
      {shown.value.length === 0 ? (
        <p class="empty">{poses.value.length === 0 ? 'The pose library is loading.' : 'No pose has that name.'}</p>
      ) : (
        <ul class="pose-grid" aria-label="Pose library">
          {shown.value.map((pose) => (
            <Tile key={pose.id} pose={pose} />
          ))}
        </ul>
      )}
    </>
  );
}

function Tile({ pose }: { pose: LibraryPose }) {
  const store = useStore();
  const place = (element: HTMLElement) => {
    if (store.state.duration.value === 0) {
      store.notify('info', 'Drop a song first: poses are placed on its beats.');
      return;
    }
    const id = store.addKey(pose.rotations, store.state.time.value, { name: pose.name });
    flyToLane(store, element, id);
  };
  return (
    <li>
      <button
        type="button"
        class="pose-tile"
        aria-label={`${pose.name}: add at the playhead`}
        title={`${pose.name}. Drag it onto the timeline, or click to add it at the playhead’s nearest beat.`}
        onPointerDown={(event) => startPoseDrag(event, pose, store)}
        onClick={(event) => {
          if (!event.currentTarget.dataset.dragged) place(event.currentTarget);
        }}
      >
        <PosePicture rotations={pose.rotations} />
        <span>{pose.name}</span>
      </button>
    </li>
  );
}

/** The key poses selected on the timeline and what can be done with them. */
function Selected() {
  const store = useStore();
  const { selection, document } = store.state;
  const chosen = document.value.keyPoses.filter((key) => selection.value.has(key.id));
  if (chosen.length === 0) return null;
  const [first] = chosen;
  return (
    <section class="selected" aria-label="Selected key poses">
      <div class="selected-picture">
        <PosePicture rotations={first.rotations} />
      </div>
      <div class="selected-text">
        <strong>{chosen.length === 1 ? (first.name ?? 'Key pose') : `${chosen.length} key poses`}</strong>
        <small>{chosen.length === 1 ? `at ${first.time.toFixed(2)} s` : 'move together'}</small>
      </div>
      {chosen.length === 1 && (
        <button
          type="button"
          class="tool"
          aria-label="Edit pose"
          title="Edit pose (double-click it)"
          onClick={() => store.editKey(first.id)}
        >
          <Icon name="pencil" />
        </button>
      )}
      <button type="button" class="tool" aria-label="Mirror" title={tip('mirror')} onClick={() => store.mirrorKeys()}>
        <Icon name="flip" />
      </button>
      <button type="button" class="tool" aria-label="Delete" title={tip('remove')} onClick={() => store.deleteKeys()}>
        <Icon name="trash" />
      </button>
    </section>
  );
}
