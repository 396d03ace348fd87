/** Zoom and scroll of the timeline, panels, help. */
import type { Context } from '../context';

/** Closest zoom, pixels per second: a frame is 20 px wide. */
export const MAX_ZOOM = 600;
/** Where the playhead is put when the view turns its page, as a share of the width. */
const PAGE_MARGIN = 0.08;

/** Actions on what is shown. */
export function viewActions({ state }: Context) {
  const fitScale = () => state.viewWidth.value / Math.max(state.duration.value, 1);
  const set = (start: number, pixelsPerSecond: number) => {
    const width = state.viewWidth.value;
    if (width <= 0) return;
    const scale = Math.min(Math.max(pixelsPerSecond, fitScale()), Math.max(MAX_ZOOM, fitScale()));
    const last = Math.max(0, state.duration.value - width / scale);
    const next = { start: Math.min(Math.max(start, 0), last), pixelsPerSecond: scale };
    const now = state.view.value;
    if (next.start !== now.start || next.pixelsPerSecond !== now.pixelsPerSecond) state.view.value = next;
  };

  return {
    setView: set,
    /** Zooms about a time that stays where it is on screen. */
    zoomAt(factor: number, time: number): void {
      const { start, pixelsPerSecond } = state.view.value;
      const scale = Math.min(Math.max(pixelsPerSecond * factor, fitScale()), Math.max(MAX_ZOOM, fitScale()));
      set(time - ((time - start) * pixelsPerSecond) / scale, scale);
    },
    /** Zooms about the playhead, or the middle when it is out of sight. */
    zoom(factor: number): void {
      const { start, pixelsPerSecond } = state.view.value;
      const span = state.viewWidth.value / pixelsPerSecond;
      const time = state.time.value;
      this.zoomAt(factor, time >= start && time <= start + span ? time : start + span / 2);
    },
    /** Shows the whole song. */
    fit: () => set(0, 0),
    scrollBy: (pixels: number) => {
      const { start, pixelsPerSecond } = state.view.value;
      set(start + pixels / pixelsPerSecond, pixelsPerSecond);
    },
    /** Takes the width of the timeline; a view that was never set shows some 24 seconds. */
    resizeView(width: number): void {
      state.viewWidth.value = width;
      const { start, pixelsPerSecond } = state.view.value;
      set(start, pixelsPerSecond || Math.max(width / 24, 24));
    },
    /** While playing the view turns its page when the playhead leaves it. */
    followTime(time: number): void {
      if (!state.followPlayhead.value || !state.playing.value) return;
      const { start, pixelsPerSecond } = state.view.value;
      const span = state.viewWidth.value / pixelsPerSecond;
      if (time < start || time > start + span * (1 - PAGE_MARGIN / 2)) set(time - span * PAGE_MARGIN, pixelsPerSecond);
    },
    toggleFollow: () => (state.followPlayhead.value = !state.followPlayhead.value),
    showPanel: (panel: 'poses' | 'dance') => (state.panel.value = panel),
    toggleHelp: (open = !state.help.value) => (state.help.value = open),
    dismiss: (id: number) => (state.notices.value = state.notices.value.filter((notice) => notice.id !== id)),
  };
}
