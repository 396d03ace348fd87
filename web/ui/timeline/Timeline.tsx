import { useComputed, useSignalEffect } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import { findSections } from '../../core/sections';
import { useStore } from '../store-context';
import { BeatLane } from './BeatLane';
import { CURVE_LANE } from '../curves/curve-space';
import { CurveTools } from '../curves/CurveTools';
import { CurveView } from '../curves/CurveView';
import { CurveLane } from './CurveLane';
import { drawTimeline } from './draw';
import { keyWidths, LANES, LANES_HEIGHT } from './geometry';
import { bindGestures } from './gestures';
import { KeyLane } from './KeyLane';
import { LoopHandles } from './LoopHandles';
import { Playhead } from './Playhead';
import { RangeLane } from './RangeLane';
import { ScrollBar } from './ScrollBar';
import { surface } from './surface';
import { TimelineBar } from './TimelineBar';
import { TrimHandles } from './TrimHandles';
import { usePainter } from './use-painter';

/** The timeline: one canvas for what stands still, elements for what can be grabbed. */
export function Timeline() {
  const store = useStore();
  const { state } = store;
  const box = useRef<HTMLDivElement>(null);

  useEffect(() => {
    const element = box.current!;
    surface.value = element;
    const observer = new ResizeObserver(() => store.resizeView(element.clientWidth));
    observer.observe(element);
    const unbind = bindGestures(element, store);
    return () => {
      observer.disconnect();
      unbind();
      surface.value = null;
    };
  }, [store]);

  useSignalEffect(() => {
    // A view of zero scale asks to be set up: a new song has come.
    if (state.view.value.pixelsPerSecond === 0 && state.viewWidth.value > 0 && state.duration.value > 0) {
      store.resizeView(state.viewWidth.value);
    }
  });

  const keys = useComputed(() => state.document.value.keyPoses);
  const scale = useComputed(() => state.view.value.pixelsPerSecond);
  const widths = useComputed(() => keyWidths(keys.value, scale.value));
  const heard = useComputed(() => (state.song.value?.complete ? state.song.value.features : null));
  const sections = useComputed(() =>
    heard.value && state.grid.value ? findSections(heard.value, state.grid.value, state.duration.value) : [],
  );
  const picture = useComputed(() => {
    const partial = state.partial.value;
    const dance = state.dance.value;
    const generating = state.generation.value.status === 'running';
    const done = dance && dance.kind !== 'preview' ? dance.motion.frames / dance.motion.fps : 0;
    return {
      view: state.view.value,
      width: state.viewWidth.value,
      duration: state.duration.value,
      waveform: state.song.value?.waveform ?? null,
      features: state.song.value?.features ?? null,
      grid: state.grid.value,
      loop: state.loop.value,
      keys: keys.value,
      widths: widths.value,
      sections: sections.value,
      selection: state.selection.value,
      danced: generating && partial ? partial.frames / partial.fps : done,
      stale: state.stale.value,
      generating,
    };
  });
  const canvas = usePainter(picture, drawTimeline);

  const curves = state.curvesShown.value;
  const lanes = LANES_HEIGHT + (curves ? LANES.curves.height : 0);
  const bending = state.curvesOpen.value;
  const height = lanes + (bending ? CURVE_LANE.height : 0);
  return (
    <div class="timeline-body">
      <TimelineBar />
      <div class="timeline-surface" ref={box} style={{ height: `${height}px` }}>
        <canvas ref={canvas} class="timeline-canvas" style={{ height: `${LANES_HEIGHT}px` }} aria-hidden="true" />
        {curves && <CurveLane />}
        {bending && <CurveView top={lanes} />}
        <BeatLane />
        <RangeLane />
        <KeyLane />
        <LoopHandles />
        <TrimHandles />
        <Playhead />
      </div>
      {bending && <CurveTools />}
      <ScrollBar />
    </div>
  );
}
