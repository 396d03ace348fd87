import { limbLabel } from '../../app/limb-labels';
import { OTHER_SIDE, type Limb } from '../../core/pose-tools';
import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';

/** What can be done with the limb of the chosen joint. */
export function LimbSection({ limb }: { limb: Limb }) {
  const store = useStore();
  const clip = store.state.poseClip.value;
  const sided = OTHER_SIDE[limb] !== limb;
  const fits = clip !== null && (clip.limb === limb || (clip.limb !== null && OTHER_SIDE[clip.limb] === limb));
  return (
    <section class="pose-section" aria-labelledby="limb-heading">
      <h3 id="limb-heading">{limbLabel(limb)}</h3>
      <div class="icon-row">
        <button
          type="button"
          class="secondary"
          title={sided ? `Give the ${limbLabel(OTHER_SIDE[limb]).toLowerCase()} the same, mirrored` : 'Mirror it'}
          onClick={() => store.mirrorLimb(limb)}
        >
          <Icon name={sided ? 'otherSide' : 'flip'} size={18} />
          {sided ? 'To other side' : 'Mirror'}
        </button>
        <button
          type="button"
          class="secondary square"
          aria-label={`Copy ${limbLabel(limb).toLowerCase()}`}
          title={tip('pose-copy-limb', 'Copy this limb')}
          onClick={() => store.copyPose(limb)}
        >
          <Icon name="copy" size={18} />
        </button>
        <button
          type="button"
          class="secondary square"
          aria-label={`Paste onto ${limbLabel(limb).toLowerCase()}`}
          title={fits ? tip('pose-paste', 'Paste the copied limb') : 'Copy a limb like this one first'}
          disabled={!fits}
          onClick={() => store.pastePose(limb)}
        >
          <Icon name="paste" size={18} />
        </button>
        <button
          type="button"
          class="secondary square"
          aria-label={`Reset ${limbLabel(limb).toLowerCase()}`}
          title="Put this limb back to rest"
          onClick={() => store.resetLimb(limb)}
        >
          <Icon name="reset" size={18} />
        </button>
      </div>
    </section>
  );
}
