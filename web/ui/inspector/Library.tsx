import { useComputed, useSignal } from '@preact/signals';
import type { LibraryPose } from '../../core/types';
import { Icon } from '../Icon';
import { flyToLane, startPoseDrag } from '../pose-drag';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';
import { PosePicture } from '../thumbs';
import { SelectedKeys } from '../timeline/SelectedKeys';

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
      <SelectedKeys />
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
  const place = (element: HTMLElement, exact: boolean) => {
    if (store.state.duration.value === 0) {
      store.notify('info', 'Drop a song first: poses are placed on its beats.');
      return;
    }
    const id = store.addKey(pose.rotations, store.state.time.value, { name: pose.name, exact });
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
          if (!event.currentTarget.dataset.dragged) place(event.currentTarget, event.altKey);
        }}
      >
        <PosePicture rotations={pose.rotations} />
        <span>{pose.name}</span>
      </button>
    </li>
  );
}
