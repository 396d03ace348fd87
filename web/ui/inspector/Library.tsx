import { useComputed, useSignal } from '@preact/signals';
import { useCallback, useRef } from 'preact/hooks';
import { POSE_FILES } from '../../app/pose-reader';
import { OWN_GROUP } from '../../app/pose-store';
import type { LibraryPose } from '../../core/types';
import { chooseFile } from '../files';
import { Icon } from '../Icon';
import { nextTile } from '../library/grid-keys';
import { libraryGroup, libraryQuery, useKeptScroll } from '../library/kept-view';
import { PoseMenu, type MenuTarget } from '../library/PoseMenu';
import { PoseTile } from '../library/PoseTile';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';
import { SelectedKeys } from '../timeline/SelectedKeys';

const STANDING = new Array<number>(72).fill(0);

/** The poses to place, by group, with search; above them what is selected on the timeline. */
export function Library() {
  const store = useStore();
  const { poses, ownPoses } = store.state;
  const [query, group] = [libraryQuery, libraryGroup];
  const search = useRef<HTMLInputElement>(null);
  useKeptScroll(search);
  const sections = useComputed(() => {
    const words = query.value.toLowerCase().split(/\s+/).filter(Boolean);
    const fits = (pose: LibraryPose) => {
      const text = `${pose.name} ${pose.group}`.toLowerCase();
      return words.every((word) => text.includes(word));
    };
    return [OWN_GROUP, ...new Set(poses.value.map((pose) => pose.group))].map((name) => {
      const all: readonly LibraryPose[] =
        name === OWN_GROUP ? ownPoses.value : poses.value.filter((pose) => pose.group === name);
      return { name, all, found: all.filter(fits) };
    });
  });
  const chosen = sections.value.filter(({ name }) => group.value === null || group.value === name);
  const searching = query.value.trim() !== '';
  const shown = chosen.filter(({ name, found }) => found.length > 0 || (name === OWN_GROUP && !searching));
  return (
    <>
      <SelectedKeys />
      <Actions />
      <label class="search">
        <Icon name="search" size={16} />
        <span class="visually-hidden">Search poses</span>
        <input
          ref={search}
          type="search"
          placeholder="Search poses"
          value={query.value}
          onInput={(event) => (query.value = event.currentTarget.value)}
        />
      </label>
      <GroupChips
        names={sections.value.map(({ name }) => name)}
        chosen={group.value}
        onChoose={(name) => (group.value = name)}
      />
      {poses.value.length === 0 && <p class="empty">The pose library is loading.</p>}
      {shown.length === 0 && <p class="empty">No pose is called that. Search for another word, or clear the search.</p>}
      <PoseSections sections={shown.map(({ name, all, found }) => ({ name, poses: searching ? found : all }))} />
    </>
  );
}

/** New poses, and poses from elsewhere. */
function Actions() {
  const store = useStore();
  const { selection, poseImportJob } = store.state;
  const [only] = selection.value;
  const one = selection.value.size === 1;
  return (
    <div class="pose-actions library-actions">
      <button type="button" class="secondary" onClick={() => store.editPose(STANDING)} title="Start from the T-pose">
        <Icon name="person" />
        New pose
      </button>
      <button type="button" class="secondary" onClick={() => store.keepPoseHere()} title={tip('add')}>
        <Icon name="pin" />
        From dance
      </button>
      <button
        type="button"
        class="secondary"
        onClick={() => (one ? store.saveKeyPose(only) : store.saveDancePose())}
        title={one ? 'Save the selected key pose to My poses' : 'Save the dance’s pose at the playhead to My poses'}
      >
        <Icon name="bookmark" />
        Save pose
      </button>
      <button
        type="button"
        class="secondary"
        disabled={poseImportJob.value !== null}
        onClick={() => chooseFile(store, POSE_FILES, (_, file) => void store.importPoseFile(file))}
        title="A pose or a dance from a BVH, SMPL npz, GLB, VRM or JSON file, or a file of saved poses"
      >
        <Icon name="upload" />
        {poseImportJob.value === null ? 'Import' : 'Reading…'}
      </button>
    </div>
  );
}

function GroupChips(props: { names: readonly string[]; chosen: string | null; onChoose(name: string | null): void }) {
  const { names, chosen, onChoose } = props;
  return (
    <fieldset class="group-chips">
      <legend class="visually-hidden">Group of poses</legend>
      {[null, ...names].map((name) => (
        <label key={name} class="group-chip">
          <input
            type="radio"
            name="pose-group"
            checked={chosen === name}
            onChange={() => onChoose(name)}
            onFocus={(event) =>
              event.currentTarget.parentElement?.scrollIntoView({ block: 'nearest', inline: 'nearest' })
            }
          />
          <span>{name ?? 'All'}</span>
        </label>
      ))}
    </fieldset>
  );
}

/** All tiles, under their headings; one of them is in the order of Tab, arrow keys move between them. */
function PoseSections({ sections }: { sections: readonly { name: string; poses: readonly LibraryPose[] }[] }) {
  const store = useStore();
  const active = useSignal<string | null>(null);
  const menu = useSignal<MenuTarget | null>(null);
  const renaming = useSignal<string | null>(null);
  const grid = useRef<HTMLDivElement>(null);
  const closeMenu = useCallback(() => (menu.value = null), [menu]);
  const all = sections.flatMap(({ poses }) => poses);
  const tabbable = all.some((pose) => pose.id === active.value) ? active.value : (all[0]?.id ?? null);

  const onKeyDown = (event: KeyboardEvent) => {
    const tiles = [...grid.current!.querySelectorAll<HTMLElement>('.pose-tile')];
    const now = tiles.indexOf(event.target as HTMLElement);
    if (now < 0 || event.ctrlKey || event.metaKey || event.altKey) return;
    const removes = event.key === 'Delete' || event.key === 'Backspace';
    // After a deletion the neighbour has the focus.
    if (removes && event.defaultPrevented) {
      const neighbour = tiles[now + 1] ?? tiles[now - 1];
      neighbour?.focus();
      return;
    }
    const places = tiles.map((tile) => tile.getBoundingClientRect());
    const next = nextTile(places, now, event.key);
    if (next < 0) return;
    event.preventDefault();
    tiles[next].focus();
  };
  const rename = (pose: LibraryPose, name: string | null) => {
    if (renaming.value !== pose.id) return;
    renaming.value = null;
    if (name !== null) store.renameOwnPose(pose.id, name);
    grid.current?.querySelector<HTMLElement>(`[data-pose="${CSS.escape(pose.id)}"]`)?.focus();
  };
  return (
    <div ref={grid} class="pose-sections" onKeyDown={onKeyDown}>
      {sections.map(({ name, poses }) => (
        <section key={name} aria-label={name}>
          <header class="group-head">
            <h3>{name}</h3>
            <small>{poses.length > 0 && poses.length}</small>
            {name === OWN_GROUP && poses.length > 0 && (
              <button
                type="button"
                class="quiet"
                onClick={() => store.exportOwnPoses()}
                title="Save all of My poses as one file"
              >
                <Icon name="download" size={16} />
                Export
              </button>
            )}
          </header>
          {poses.length === 0 ? (
            <p class="empty">
              Poses that you save come here. Press Save pose to keep the one on stage, or Import to take one from a
              file.
            </p>
          ) : (
            <ul class="pose-grid" aria-label={name}>
              {poses.map((pose) => (
                <PoseTile
                  key={pose.id}
                  pose={pose}
                  tabbable={pose.id === tabbable}
                  renaming={renaming.value === pose.id}
                  onFocus={() => (active.value = pose.id)}
                  onMenu={(anchor) => (menu.value = { pose, anchor })}
                  onRename={(text) => {
                    if (renaming.value === pose.id) rename(pose, text);
                    else renaming.value = pose.id;
                  }}
                />
              ))}
            </ul>
          )}
        </section>
      ))}
      {menu.value && (
        <PoseMenu
          key={menu.value.pose.id}
          target={menu.value}
          onClose={closeMenu}
          onRename={(pose) => (renaming.value = pose.id)}
        />
      )}
    </div>
  );
}
