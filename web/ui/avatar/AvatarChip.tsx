import { useStore } from '../store-context';

/** Over the stage: which character is being opened, where that takes a while. */
export function AvatarChip() {
  const job = useStore().state.avatarJob.value;
  if (!job) return null;
  return (
    <div class="chip work-chip avatar-chip" role="status">
      <span class="work-text">Opening “{job}” …</span>
    </div>
  );
}
