import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';
import { ToolButton } from '../ToolButton';

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
        <ToolButton
          icon="copy"
          label="Copy pose"
          title={tip('pose-copy')}
          size={18}
          class="secondary square"
          onClick={() => store.copyPose()}
        />
        <ToolButton
          icon="paste"
          label="Paste"
          title={tip('pose-paste')}
          size={18}
          disabled={clip === null}
          class="secondary square"
          onClick={() => store.pastePose()}
        />
        <ToolButton
          icon="reset"
          label="Reset pose"
          title={tip('pose-reset')}
          size={18}
          class="secondary square"
          onClick={() => store.resetPose()}
        />
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
