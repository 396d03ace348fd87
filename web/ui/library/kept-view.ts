/** What the library shows, kept while the pose editor or another panel is in its place. */
import { signal } from '@preact/signals';
import type { RefObject } from 'preact';
import { useLayoutEffect } from 'preact/hooks';

/** The words searched for. */
export const libraryQuery = signal('');
/** The one group that is shown; null for all. */
export const libraryGroup = signal<string | null>(null);
let scrollTop = 0;

/** The panel around an element comes back scrolled as it was left. */
export function useKeptScroll(inside: RefObject<HTMLElement | null>): void {
  useLayoutEffect(() => {
    const panel = inside.current!.closest<HTMLElement>('.panel')!;
    panel.scrollTop = scrollTop;
    const keep = () => void (scrollTop = panel.scrollTop);
    panel.addEventListener('scroll', keep, { passive: true });
    return () => panel.removeEventListener('scroll', keep);
  }, [inside]);
}
