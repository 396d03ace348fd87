import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';

/** What can be done with the whole pose. */
export function PoseSection() {
  const store = useStore();
  const clip = store.state.poseClip.value;
  return (
    <section class="pose-section" aria-labelledby="pose-heading">
      <h3 id="pose-heading">Whole pose</h3>
      <div class="icon-row">
        <button type="button" class="secondary" title={tip('mirror')} onClick={() => store.mirrorDraft()}>
          <Icon name="flip" size={18} />
          Mirror
        </button>
        <button
          type="button"
          class="secondary square"
          aria-label="Copy pose"
          title={tip('pose-copy')}
          onClick={() => store.copyPose()}
        >
          <Icon name="copy" size={18} />
        </button>
        <button
          type="button"
          class="secondary square"
          aria-label="Paste"
          title={tip('pose-paste')}
          disabled={clip === null}
          onClick={() => store.pastePose()}
        >
          <Icon name="paste" size={18} />
        </button>
        <button
          type="button"
          class="secondary square"
          aria-label="Reset pose"
          title={tip('pose-reset')}
          onClick={() => store.resetPose()}
        >
          <Icon name="reset" size={18} />
        </button>
      </div>
      <div class="tool-row">
        <button
          type="button"
          class="secondary"
          title="Take the tilt out of the hips"
          onClick={() => store.standUpright()}
        >
          <Icon name="person" size={18} />
          Upright
        </button>
        <button
          type="button"
          class="secondary"
          title="Put the soles of the standing feet flat on the floor"
          onClick={() => store.levelFeet()}
        >
          <Icon name="feet" size={18} />
          Flat feet
        </button>
      </div>
      <button
        type="button"
        class="secondary"
        title="Give the figure the pose that the dance has at the playhead"
        disabled={!store.state.dance.value}
        onClick={() => store.takePoseOfDance()}
      >
        <Icon name="pin" size={18} />
        Take the dance’s pose
      </button>
    </section>
  );
}
