import { useEffect, useRef } from 'preact/hooks';
import type { LibraryPose } from '../../core/types';
import { Icon, type IconName } from '../Icon';
import { useStore } from '../store-context';
import { isOwn } from './PoseTile';

/** Where a menu is open, and for which pose. */
export interface MenuTarget {
  pose: LibraryPose;
  anchor: HTMLElement;
}

interface Item {
  icon: IconName;
  label: string;
  keys?: string;
  run(): void;
}

interface Props {
  target: MenuTarget;
  onClose(): void;
  onRename(pose: LibraryPose): void;
}

/** What can be done with a pose of the library, besides adding it. */
export function PoseMenu({ target, onClose, onRename }: Props) {
  const store = useStore();
  const menu = useRef<HTMLDivElement>(null);
  const { pose, anchor } = target;

  useEffect(() => {
    const element = menu.current!;
    element.showPopover();
    const at = anchor.getBoundingClientRect();
    const { width, height } = element.getBoundingClientRect();
    const below = at.bottom + 4 + height <= innerHeight - 8;
    element.style.left = `${Math.max(8, Math.min(at.right - width, innerWidth - width - 8))}px`;
    element.style.top = `${Math.max(8, below ? at.bottom + 4 : at.top - height - 4)}px`;
    element.querySelector('button')?.focus();
    const closed = (event: Event) => {
      if ((event as ToggleEvent).newState !== 'closed') return;
      // Where the focus went by itself it stays; otherwise it goes back to where the menu came from.
      if (element.contains(document.activeElement) || document.activeElement === document.body) anchor.focus();
      onClose();
    };
    element.addEventListener('toggle', closed);
    return () => element.removeEventListener('toggle', closed);
  }, [anchor, onClose]);

  const items: Item[] = [
    {
      icon: 'pencil',
      label: 'Edit a copy',
      run: () => store.editPose(pose.rotations, { name: pose.name }),
    },
    ...(isOwn(pose)
      ? ([
          { icon: 'rename', label: 'Rename', keys: 'F2', run: () => onRename(pose) },
          { icon: 'trash', label: 'Delete', keys: 'Del', run: () => store.deleteOwnPose(pose.id) },
        ] satisfies Item[])
      : ([
          { icon: 'bookmark', label: 'Save to My poses', run: () => void store.saveOwnPose(pose.rotations, pose.name) },
        ] satisfies Item[])),
  ];
  const onKeyDown = (event: KeyboardEvent) => {
    const buttons = [...menu.current!.querySelectorAll('button')];
    const now = buttons.indexOf(document.activeElement as HTMLButtonElement);
    const next: Record<string, number> = { ArrowDown: now + 1, ArrowUp: now - 1, Home: 0, End: buttons.length - 1 };
    event.stopPropagation();
    if (event.key === 'Tab') menu.current!.hidePopover();
    if (!(event.key in next)) return;
    event.preventDefault();
    buttons[(next[event.key] + buttons.length) % buttons.length].focus();
  };
  return (
    <div ref={menu} class="pose-menu" popover="auto" role="menu" aria-label={pose.name} onKeyDown={onKeyDown}>
      {items.map(({ icon, label, keys, run }) => (
        <button
          key={label}
          type="button"
          role="menuitem"
          tabIndex={-1}
          onClick={() => {
            menu.current!.hidePopover();
            run();
          }}
        >
          <Icon name={icon} size={16} />
          <span>{label}</span>
          {keys && <kbd aria-hidden="true">{keys}</kbd>}
        </button>
      ))}
    </div>
  );
}
