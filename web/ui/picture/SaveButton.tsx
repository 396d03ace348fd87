import { Progress } from '../export/Progress';
import { Icon } from '../Icon';
import { takeFocus } from '../video/VideoProgress';
import { cancelMaking, making, type Making } from './make';

/** Saves a picture; while it is made, says how far it is and stops it. */
export function SaveButton(props: {
  what: Making;
  label: string;
  disabled?: boolean;
  full?: boolean;
  onSave: () => void;
}) {
  const { what, label, disabled, full, onSave } = props;
  const done = making[what].value;
  const kind = full ? 'secondary full' : 'primary motion-tone';
  if (done === null) {
    return (
      <button ref={takeFocus} type="button" class={kind} disabled={disabled} onClick={onSave}>
        <Icon name="imageDown" />
        {label}
      </button>
    );
  }
  return (
    <button
      ref={takeFocus}
      type="button"
      class={`secondary progress ${full ? 'full' : ''}`}
      title="Stop it"
      onClick={() => cancelMaking(what)}
    >
      <Progress word="Cancel" done={done} />
    </button>
  );
}
