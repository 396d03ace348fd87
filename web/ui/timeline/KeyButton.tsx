import { barAndBeat } from '../../app/snapping';
import type { KeyPose } from '../../core/types';
import { Icon } from '../Icon';
import { matches } from '../shortcuts';
import { useStore } from '../store-context';
import { PosePicture } from '../thumbs';
import { COMPACT_WIDTH } from './geometry';
import { beginKeyDrag, pressedKey } from './key-drag';
import { focusedKey } from './lane-signals';

/** What keys do on a key pose. Those of the table (Enter, Delete...) that are about it are here too: they then mean this one. */
const HELP =
  'Left and right move it by a beat, with Shift by a frame; up and down go to its neighbours, with Shift they select. Enter edits it, Space selects, Delete deletes.';

/** One key pose: a thumbnail, or a diamond where there is no room for one. */
export function KeyButton(props: { pose: KeyPose; width: number; chosen: boolean; tabStop: boolean }) {
  const { pose, width, chosen, tabStop } = props;
  const store = useStore();
  const place = barAndBeat(store.state.grid.peek(), pose.time);
  const compact = width <= COMPACT_WIDTH;
  const percent = Math.round((pose.strength ?? 1) * 100);
  const words = [
    pose.name ?? 'Key pose',
    place ? `bar ${place.bar} beat ${place.beat}` : '',
    `${pose.time.toFixed(2)} s`,
    pose.locked ? 'locked' : '',
    pose.suggested ? 'suggested' : '',
    percent < 100 ? `strength ${percent} %` : '',
  ].filter(Boolean);
  const kinds = [
    'key-pose',
    chosen && 'chosen',
    compact && 'compact',
    pose.locked && 'locked',
    pose.suggested && 'suggested',
    percent < 100 && 'weak',
  ];

  /** Goes to another key pose of the list; `extend` selects up to it. */
  const walk = (id: string | undefined | null, extend: boolean) => {
    if (!id) return;
    if (extend) store.selectTo(id);
    else store.selectKey(id);
    focusedKey.value = id;
    const target = store.state.document.value.keyPoses.find((key) => key.id === id);
    if (target) store.revealTime(target.time);
  };
  const first = () => store.state.document.value.keyPoses[0]?.id;
  const last = () => store.state.document.value.keyPoses.at(-1)?.id;
  /** After copying, the copies have the keyboard. */
  const toCopies = (copy: () => void) => {
    copy();
    const [id] = store.state.selection.value;
    if (id) focusedKey.value = id;
  };

  /** Deletes the selected ones; what comes after this one, else before it, has the keyboard then, else the playhead. */
  const remove = () => {
    if (!chosen) store.selectKey(pose.id);
    store.deleteKeys();
    const left = store.state.document.value.keyPoses;
    if (left.some(({ id }) => id === pose.id)) return;
    const next = left.find(({ time }) => time > pose.time) ?? left.at(-1);
    if (next) walk(next.id, false);
    else document.querySelector<HTMLElement>('.playhead-grip')?.focus();
  };

  const onKeyDown = (event: KeyboardEvent) => {
    const { key, shiftKey } = event;
    const plain = !event.ctrlKey && !event.metaKey && !event.altKey;
    const own = () => chosen || store.selectKey(pose.id);
    const unit = shiftKey ? 'frame' : 'beat';
    const acts: Record<string, () => void> = {
      ArrowLeft: () => (own(), store.nudgeKeys(-1, unit)),
      ArrowRight: () => (own(), store.nudgeKeys(1, unit)),
      ArrowUp: () => walk(store.neighbourOf(pose.id, -1), shiftKey),
      ArrowDown: () => walk(store.neighbourOf(pose.id, 1), shiftKey),
      Home: () => walk(first(), shiftKey),
      End: () => walk(last(), shiftKey),
      Enter: () => (shiftKey ? remove() : store.editKey(pose.id)),
      ' ': () => store.selectKey(pose.id, true),
      Delete: remove,
      Backspace: remove,
    };
    let run = plain ? acts[key] : undefined;
    if (matches(event, 'Mod+D')) run = () => toCopies(() => store.duplicateKeys());
    if (matches(event, 'Mod+V')) run = () => toCopies(() => store.pasteKeys());
    if (!run) return;
    event.preventDefault();
    event.stopPropagation();
    run();
  };

  return (
    <button
      type="button"
      class={kinds.filter(Boolean).join(' ')}
      data-grab
      data-key={pose.id}
      tabIndex={tabStop ? 0 : -1}
      aria-pressed={chosen}
      aria-label={words.join(', ')}
      title={`${words.join(', ')}. ${HELP}`}
      onPointerDown={(event) => beginKeyDrag(event, pose.id, store)}
      onDblClick={() => store.editKey(pose.id)}
      onKeyDown={onKeyDown}
      onFocus={() => {
        focusedKey.value = pose.id;
        // The pointer has its own way to select; the keyboard selects what it comes to.
        if (pressedKey.current !== pose.id && !store.state.selection.value.has(pose.id)) store.selectKey(pose.id);
      }}
      onBlur={() => {
        if (focusedKey.value === pose.id && document.hasFocus()) queueMicrotask(() => releaseFocus(pose.id));
      }}
    >
      {compact ? <span class="diamond" /> : <PosePicture rotations={pose.rotations} />}
      {chosen && !compact && (
        <span class="key-badge key-check">
          <Icon name="check" size={12} />
        </span>
      )}
      {pose.locked && !compact && (
        <span class="key-badge key-lock">
          <Icon name="lock" size={12} />
        </span>
      )}
      {percent < 100 && !compact && (
        <span class="key-strength">
          <span style={{ height: `${percent}%` }} />
        </span>
      )}
    </button>
  );
}

/** Forgets the focused key pose once something else really has the focus. */
function releaseFocus(id: string): void {
  if (focusedKey.value === id && document.activeElement !== document.body) focusedKey.value = null;
}
