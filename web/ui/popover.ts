/** What the page's menus share; each is a popover of the browser's own. */

/** Room between a menu and the page's edges, and its button, CSS pixels. */
export const MARGIN = 8;

/** Puts an open menu above its button, where the stage is, or below it where there is more room. */
export function placeMenu(menu: HTMLElement, opener: HTMLElement): void {
  const button = opener.getBoundingClientRect();
  const { width } = menu.getBoundingClientRect();
  const above = button.top - 2 * MARGIN;
  const below = innerHeight - button.bottom - 2 * MARGIN;
  const up = above >= below;
  menu.style.maxHeight = `${Math.max(above, below)}px`;
  menu.style.left = `${Math.max(MARGIN, Math.min(button.left, innerWidth - width - MARGIN))}px`;
  menu.style.top = up ? 'auto' : `${button.bottom + MARGIN}px`;
  menu.style.bottom = up ? `${innerHeight - button.top + MARGIN}px` : 'auto';
}

/** Esc belongs to the innermost thing, the open menu: it is left, and the page does not hear of the key. */
export function leaveByEscape(event: KeyboardEvent, leave: () => void): void {
  if (event.key !== 'Escape') return;
  event.preventDefault();
  event.stopPropagation();
  leave();
}

/** Closes a menu and gives the keyboard back to its button. */
export function closeMenu(menu: HTMLElement | null, opener: HTMLElement | null): void {
  menu?.hidePopover();
  opener?.focus();
}
