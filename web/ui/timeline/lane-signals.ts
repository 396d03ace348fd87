/** What the timeline's elements and gestures share while something is dragged or focused. */
import { signal } from '@preact/signals';
import type { TimeRange } from '../../core/document';

/** The key pose that has the keyboard, so that it stays an element and focused when it moves past others or out of sight. */
export const focusedKey = signal<string | null>(null);
/** The stretch that is being selected by dragging in the key lane, seconds. */
export const band = signal<TimeRange | null>(null);
/** The key pose under the pointer in a drag: its time, and whether it is a copy. */
export const dragHint = signal<{ time: number; copy: boolean } | null>(null);
