import type { OwnPose } from '../../app/pose-store';
import type { LibraryPose } from '../../core/types';
import { Icon } from '../Icon';
import { flyToLane, holdScroll, startPoseDrag } from '../pose-drag';
import { useStore } from '../store-context';
import { PosePicture } from '../thumbs';

/** True for a pose of the visitor's own. */
export const isOwn = (pose: LibraryPose): pose is OwnPose => 'savedAt' in pose;

interface Props {
  pose: LibraryPose;
  /** The one tile of the grid that Tab reaches; arrow keys go on from there. */
  tabbable: boolean;
  renaming: boolean;
  onFocus(): void;
  onMenu(anchor: HTMLElement): void;
  onRename(name: string | null): void;
}

/** One pose to drag or to add; what else can be done with it is in its menu. */
export function PoseTile({ pose, tabbable, renaming, onFocus, onMenu, onRename }: Props) {
  const store = useStore();
  const place = (element: HTMLElement, exact: boolean) => {
    if (store.state.duration.value === 0) {
      store.notify('info', 'Drop a song first: poses are placed on its beats.');
      return;
    }
    const id = store.addKey(pose.rotations, store.state.time.value, { name: pose.name, exact });
    flyToLane(store, element, id);
  };
  const onKeyDown = (event: KeyboardEvent & { currentTarget: HTMLElement }) => {
    if (event.key === 'ContextMenu' || (event.key === 'F10' && event.shiftKey)) onMenu(event.currentTarget);
    else if (isOwn(pose) && event.key === 'F2') onRename(pose.name);
    else if (isOwn(pose) && (event.key === 'Delete' || event.key === 'Backspace')) store.deleteOwnPose(pose.id);
    else return;
    event.preventDefault();
  };
  return (
    <li class="pose-cell">
      <button
        type="button"
        class="pose-tile"
        data-pose={pose.id}
        tabIndex={tabbable ? 0 : -1}
        aria-label={`${pose.name}: add at the playhead`}
        aria-keyshortcuts="Enter Shift+F10"
        title={`${pose.name}. Drag it onto the timeline, or click to add it at the playhead’s nearest beat (with Alt exactly there).`}
        onFocus={onFocus}
        onKeyDown={onKeyDown}
        onPointerDown={(event) => startPoseDrag(event, pose, store)}
        onTouchMove={holdScroll}
        onContextMenu={(event) => {
          event.preventDefault();
          // A finger that rests drags; the keyboard's own key comes through onKeyDown.
          if ((event as MouseEvent as PointerEvent).pointerType === 'mouse') onMenu(event.currentTarget);
        }}
        onClick={(event) => {
          if (!event.currentTarget.dataset.dragged) place(event.currentTarget, event.altKey);
        }}
      >
        <PosePicture rotations={pose.rotations} />
        <span>{pose.name}</span>
      </button>
      <button
        type="button"
        class="tile-more"
        tabIndex={tabbable ? 0 : -1}
        aria-label={`More for ${pose.name}`}
        aria-haspopup="menu"
        title="Edit, and more"
        onClick={(event) => onMenu(event.currentTarget)}
      >
        <Icon name="more" size={16} />
      </button>
      {renaming && <RenameField name={pose.name} onDone={onRename} />}
    </li>
  );
}

function RenameField({ name, onDone }: { name: string; onDone(name: string | null): void }) {
  return (
    <input
      class="tile-rename"
      type="text"
      aria-label={`New name of ${name}`}
      maxLength={80}
      defaultValue={name}
      ref={(field) => {
        if (!field || field.dataset.begun) return;
        field.dataset.begun = 'yes';
        field.focus();
        field.select();
      }}
      onBlur={(event) => onDone(event.currentTarget.value)}
      onKeyDown={(event) => {
        event.stopPropagation();
        if (event.key === 'Enter') event.currentTarget.blur();
        if (event.key === 'Escape') {
          event.currentTarget.value = name;
          event.currentTarget.blur();
        }
      }}
    />
  );
}
