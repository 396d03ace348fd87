/** Which key poses are selected. Never a step of undo. */
import { lowerBound } from '../../core/snap';
import type { Context } from '../context';

/** Actions on the selection. */
export function keySelection({ state }: Context) {
  /** Where a range of selected key poses begins: the one that was chosen last on its own. */
  let anchor: string | null = null;
  const keys = () => state.document.value.keyPoses;

  return {
    /** Selects one key pose, or none; `extend` adds it or takes it out. */
    selectKey(id: string | null, extend = false): void {
      if (id !== null && !keys().some((key) => key.id === id)) return;
      if (id === null) state.selection.value = new Set();
      else if (!extend) state.selection.value = new Set([id]);
      else {
        const next = new Set(state.selection.value);
        if (!next.delete(id)) next.add(id);
        state.selection.value = next;
      }
      anchor = id;
    },

    /** Selects all from the key pose that was chosen last on its own to this one. */
    selectTo(id: string): void {
      const list = keys();
      const to = list.findIndex((key) => key.id === id);
      if (to < 0) return;
      let from = list.findIndex((key) => key.id === anchor);
      if (from < 0) from = to;
      anchor = list[from].id;
      state.selection.value = new Set(list.slice(Math.min(from, to), Math.max(from, to) + 1).map((key) => key.id));
    },

    /** Selects the key poses between two times, and those in `beside`. */
    selectBetween(start: number, end: number, beside: ReadonlySet<string> = new Set()): void {
      const list = keys();
      const times = list.map((key) => key.time);
      const inside = list.slice(lowerBound(times, Math.min(start, end)), lowerBound(times, Math.max(start, end)));
      const next = new Set([...beside, ...inside.map((key) => key.id)]);
      const now = state.selection.value;
      if (next.size !== now.size || [...next].some((id) => !now.has(id))) state.selection.value = next;
    },

    /** Selects exactly these. */
    selectOnly: (ids: ReadonlySet<string>) => void (state.selection.value = ids),

    /** Selects all key poses. */
    selectAll(): void {
      state.selection.value = new Set(keys().map((key) => key.id));
    },

    /** The key pose before or after another, by its id; null at the ends. */
    neighbourOf(id: string, step: -1 | 1): string | null {
      const list = keys();
      const index = list.findIndex((key) => key.id === id);
      return index < 0 ? null : (list[index + step]?.id ?? null);
    },
  };
}
