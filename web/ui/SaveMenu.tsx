import { useRef } from 'preact/hooks';
import { chooseProject } from './files';
import { Icon, type IconName } from './Icon';
import { closeMenu, leaveByEscape } from './popover';
import { keyText, SHORTCUTS } from './shortcuts';
import { useStore } from './store-context';

const MENU_ID = 'project-menu';

/** The project as a file: saved with its song or without, opened, and the demo. The browser's own popover. */
export function SaveMenu() {
  const store = useStore();
  const menu = useRef<HTMLDivElement>(null);
  const opener = useRef<HTMLButtonElement>(null);
  const { document, song, aside } = store.state;
  const then = (run: () => void) => () => {
    menu.current?.hidePopover();
    run();
  };
  const name = document.value.song?.name;
  return (
    <>
      <button
        ref={opener}
        type="button"
        class="tool"
        aria-label="Save the project"
        title="Save the project as a file, with the song or without"
        aria-haspopup="true"
        popovertarget={MENU_ID}
      >
        <Icon name="download" />
      </button>
      <div
        id={MENU_ID}
        class="menu project-menu"
        popover="auto"
        ref={menu}
        role="group"
        aria-label="Project"
        onToggle={(event) => event.newState === 'open' && menu.current?.querySelector('button')?.focus()}
        onKeyDown={(event) => leaveByEscape(event, () => closeMenu(menu.current, opener.current))}
      >
        <Entry
          icon="music"
          text="Save with the song inside"
          hint={name ? `One file that opens anywhere` : 'There is no song yet: the same as without'}
          shortcut="save"
          onClick={then(() => void store.saveProject(true))}
        />
        <Entry
          icon="download"
          text="Save without the song"
          hint="A small file; opening it asks for the song"
          onClick={then(() => void store.saveProject(false))}
        />
        <Entry
          icon="fileOut"
          text="Export the dance"
          hint="A file for Blender, game engines or Python"
          shortcut="export"
          onClick={then(() => store.toggleExport(true))}
        />
        <Entry
          icon="follow"
          text="Save as a video"
          hint="MP4 or WebM with the song, wide, square or upright"
          shortcut="video"
          onClick={then(() => store.toggleVideo(true))}
        />
        <Entry
          icon="imageDown"
          text="Save a picture"
          hint="The stage, or all key poses on one sheet"
          onClick={then(() => store.toggleVideo(true, 'picture'))}
        />
        <Entry
          icon="share"
          text="Share as a link"
          hint="The whole dance in an address"
          shortcut="share"
          onClick={then(() => store.toggleShare(true))}
        />
        <hr />
        <Entry icon="folder" text="Open a project" shortcut="open" onClick={then(() => chooseProject(store))} />
        {aside.value > 0 && (
          <Entry icon="undo" text="Back to the project before the link" onClick={then(() => void store.openAside())} />
        )}
        {!song.value?.demo && <Entry icon="play" text="Show the demo" onClick={then(() => void store.openDemo())} />}
      </div>
    </>
  );
}

function Entry(props: { icon: IconName; text: string; hint?: string; shortcut?: string; onClick: () => void }) {
  const keys = SHORTCUTS.find((each) => each.id === props.shortcut)?.keys[0];
  return (
    <button type="button" class="menu-entry" onClick={props.onClick}>
      <Icon name={props.icon} />
      <span>
        {props.text}
        {props.hint && <small>{props.hint}</small>}
      </span>
      {keys && <kbd>{keyText(keys)}</kbd>}
    </button>
  );
}
