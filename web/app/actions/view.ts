/** Zoom and scroll of the timeline, panels, help. */
import type { Context } from '../context';
import type { Snap } from '../../core/types';
import type { Panel } from '../state';

/** Closest zoom, pixels per second: a frame is 20 px wide. */
const MAX_ZOOM = 600;
/** Room before the first and after the last beat, so that poses there are seen whole, pixels. */
const VIEW_PADDING = 30;
/** A new song opens with this much of it in sight, but not below this scale. */
const OPENING_SECONDS = 24;
const MIN_OPENING_SCALE = 24;
/** Where the playhead is put when the view turns its page, as a share of the width. */
const PAGE_MARGIN = 0.08;

const SNAP_ORDER: readonly Snap[] = ['bar', 'beat', 'half', 'off'];

/** Actions on what is shown. */
export function viewActions({ state, announce }: Context) {
  const fitScale = () => Math.max(1, state.viewWidth.value - 2 * VIEW_PADDING) / Math.max(state.duration.value, 1);
  const set = (start: number, pixelsPerSecond: number) => {
    const width = state.viewWidth.value;
    if (width <= 0) return;
    const scale = Math.min(Math.max(pixelsPerSecond, fitScale()), Math.max(MAX_ZOOM, fitScale()));
    const first = -VIEW_PADDING / scale;
    const last = Math.max(first, state.duration.value + (VIEW_PADDING - width) / scale);
    const next = { start: Math.min(Math.max(start, first), last), pixelsPerSecond: scale };
    const now = state.view.value;
    if (next.start !== now.start || next.pixelsPerSecond !== now.pixelsPerSecond) state.view.value = next;
  };

  const inSight = (time: number) => {
    const { start, pixelsPerSecond } = state.view.value;
    return time >= start && time <= start + state.viewWidth.value / pixelsPerSecond;
  };
  /** Who scrolls away from the playhead wants to stay there until it comes by. */
  let lookingElsewhere = false;
  const look = (start: number, pixelsPerSecond: number) => {
    set(start, pixelsPerSecond);
    lookingElsewhere = !inSight(state.time.value);
  };

  return {
    /** Camera: follow the dancer or stay. */
    toggleCamera: () => (state.cameraFollows.value = !state.cameraFollows.value),
    /** Camera: back to the opening view. */
    frameFigure: () => (state.frameRequests.value += 1),
    setView: look,
    /** Zooms about a time that stays where it is on screen. */
    zoomAt(factor: number, time: number): void {
      const { start, pixelsPerSecond } = state.view.value;
      const scale = Math.min(Math.max(pixelsPerSecond * factor, fitScale()), Math.max(MAX_ZOOM, fitScale()));
      look(time - ((time - start) * pixelsPerSecond) / scale, scale);
    },
    /** Zooms about the playhead, or the middle when it is out of sight. */
    zoom(factor: number): void {
      const { start, pixelsPerSecond } = state.view.value;
      const span = state.viewWidth.value / pixelsPerSecond;
      const time = state.time.value;
      this.zoomAt(factor, time >= start && time <= start + span ? time : start + span / 2);
    },
    /** Shows the whole song. */
    fit: () => set(-Infinity, 0),
    /** Zooms to the selected key poses; without two of them to the loop, else to the whole song. */
    showSelection(): void {
      const chosen = state.document.value.keyPoses.filter((key) => state.selection.value.has(key.id));
      const loop = state.loop.value;
      const [start, end] =
        chosen.length > 1 ? [chosen[0].time, chosen[chosen.length - 1].time] : loop ? [loop.start, loop.end] : [0, 0];
      if (end <= start) {
        this.fit();
        return;
      }
      const scale = Math.max(1, state.viewWidth.value - 4 * VIEW_PADDING) / (end - start);
      const shown = Math.min(Math.max(scale, fitScale()), MAX_ZOOM);
      look((start + end) / 2 - state.viewWidth.value / shown / 2, shown);
    },
    scrollBy: (pixels: number) => {
      const { start, pixelsPerSecond } = state.view.value;
      look(start + pixels / pixelsPerSecond, pixelsPerSecond);
    },
    /** Takes the width of the timeline; a view that was never set shows some 24 seconds. */
    resizeView(width: number): void {
      state.viewWidth.value = width;
      const { start, pixelsPerSecond } = state.view.value;
      if (pixelsPerSecond > 0) set(start, pixelsPerSecond);
      else set(-Infinity, Math.max(width / OPENING_SECONDS, MIN_OPENING_SCALE));
    },
    /** Scrolls as little as needed to bring a time into sight. */
    revealTime(time: number): void {
      const { start, pixelsPerSecond } = state.view.value;
      if (pixelsPerSecond <= 0) return;
      const span = state.viewWidth.value / pixelsPerSecond;
      const margin = Math.min(VIEW_PADDING / pixelsPerSecond, span / 4);
      if (time < start + margin) set(time - margin, pixelsPerSecond);
      else if (time > start + span - margin) set(time + margin - span, pixelsPerSecond);
    },
    /** While playing the view turns its page when the playhead leaves it. */
    followTime(time: number): void {
      if (!state.playing.value) lookingElsewhere = false;
      if (!state.followPlayhead.value || !state.playing.value) return;
      if (lookingElsewhere) {
        lookingElsewhere = !inSight(time);
        return;
      }
      const { start, pixelsPerSecond } = state.view.value;
      const span = state.viewWidth.value / pixelsPerSecond;
      if (time < start || time > start + span * (1 - PAGE_MARGIN / 2)) set(time - span * PAGE_MARGIN, pixelsPerSecond);
    },
    /** What key poses snap to. */
    setSnap: (snap: Snap) => (state.snap.value = snap),
    /** The next of bar, beat, half beat, off. */
    cycleSnap(): void {
      const next = SNAP_ORDER[(SNAP_ORDER.indexOf(state.snap.value) + 1) % SNAP_ORDER.length];
      state.snap.value = next;
      announce(next === 'off' ? 'Snapping off.' : `Snaps to ${next === 'half' ? 'half beats' : `${next}s`}.`);
    },
    /** The timeline follows the playhead while it plays, from now on. */
    toggleFollow(): void {
      const follow = !state.followPlayhead.value;
      state.followPlayhead.value = follow;
      lookingElsewhere = false;
      if (follow) this.revealTime(state.time.value);
      announce(follow ? 'The timeline follows the playhead.' : 'The timeline stays where it is.');
    },
    showPanel: (panel: Panel) => (state.panel.value = panel),
    /** Kinetic velocity against the music on the timeline: shown or hidden. */
    toggleCurves: (open = !state.curvesShown.value) => (state.curvesShown.value = open),
    toggleHelp: (open = !state.help.value) => (state.help.value = open),
    dismiss: (id: number) => (state.notices.value = state.notices.value.filter((notice) => notice.id !== id)),
  };
}
