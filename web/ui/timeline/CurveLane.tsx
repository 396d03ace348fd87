import { useComputed } from '@preact/signals';
import { documentOnStage } from '../../app/on-stage';
import spec from '../../core/spec.json';
import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';
import { circlesFit, drawCurves, speedTop } from './draw-curves';
import { LANES } from './geometry';
import { usePainter } from './use-painter';

/** Kinetic velocity and motion beats over the music's onsets and beats (paper A, figure 9), on the timeline's own time axis. */
export function CurveLane() {
  const store = useStore();
  const { state } = store;
  const picture = useComputed(() => ({
    view: state.view.value,
    width: state.viewWidth.value,
    duration: state.duration.value,
    report: state.report.value,
    features: state.song.value?.features ?? null,
    grid: documentOnStage(state).grid ?? state.song.value?.grid ?? null,
    fps: state.onStage.value?.motion.fps ?? spec.fps,
  }));
  const canvas = usePainter(picture, drawCurves);

  const { report } = picture.value;
  const far = useComputed(() => {
    const { duration, report: now, view } = picture.value;
    return now !== null && duration > 0 && !circlesFit(now.motionBeats.length, duration, view);
  });
  return (
    <div
      class="curve-lane"
      role="group"
      aria-label="Motion against music"
      style={{ top: `${LANES.curves.top}px`, height: `${LANES.curves.height}px` }}
    >
      <canvas
        ref={canvas}
        class="timeline-canvas"
        style={{ height: `${LANES.curves.height}px` }}
        role="img"
        aria-label={
          report
            ? `Speed of the limbs over the song, up to ${speedTop(report.speed).toFixed(2)} metres a second, with ${report.motionBeats.length} motion beats over the music’s onsets and beats.`
            : 'Nothing is measured yet.'
        }
      />
      <p class="curve-legend">
        {report ? (
          <>
            <span class="curve-key speed">
              Limb speed, 0–{speedTop(report.speed).toFixed(2)} <abbr title="metres per second">m/s</abbr>
            </span>
            {far.value ? (
              <span>Zoom in for motion beats</span>
            ) : (
              <>
                <span class="curve-key hit">
                  <span>
                    <span class="wide">Motion beat, </span>on a beat
                  </span>
                </span>
                <span class="curve-key miss">
                  off<span class="wide"> the beat</span>
                </span>
              </>
            )}
            <span class="curve-key onset wide">Onsets</span>
            <span class="curve-key beat wide">Beats</span>
          </>
        ) : (
          <span>Generate a dance to see its motion against the music.</span>
        )}
      </p>
      <button
        type="button"
        class="tool curve-close"
        data-grab
        aria-label="Hide motion against music"
        title={tip('curves', 'Hide motion against music')}
        onClick={() => store.toggleCurves(false)}
      >
        <Icon name="close" size={16} />
      </button>
    </div>
  );
}
