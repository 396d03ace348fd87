import { limbOf } from '../../core/pose-tools';
import { SaveDraft } from '../library/SaveDraft';
import { BlendSection } from '../pose/BlendSection';
import { JointSection } from '../pose/JointSection';
import { LimbSection } from '../pose/LimbSection';
import { PoseSection } from '../pose/PoseSection';
import { TurnSection } from '../pose/TurnSection';
import { VariationSection } from '../pose/VariationSection';
import { useStore } from '../store-context';

/** Numbers and tools for the pose on the gizmo: the joint, its limb, the whole pose; what is rarer is folded away. */
export function PoseEditor() {
  const { joint } = useStore().state.draft.value ?? {};
  if (joint === undefined) return null;
  const limb = joint === null ? null : limbOf(joint);
  return (
    <div class="pose-editor">
      <JointSection />
      {limb && <LimbSection limb={limb} />}
      <PoseSection />
      <SaveDraft />
      <TurnSection />
      <BlendSection />
      <VariationSection />
      <p class="hint">
        Each change can be undone. The figure always stands on its lowest point. The dance passes through this pose
        exactly when key strength is 100%.
      </p>
    </div>
  );
}
