import { useSignal } from '@preact/signals';
import { useEffect, useId } from 'preact/hooks';

/** A dial from 0 to 100% with a sentence; one drag is one change. */
export function Slider(props: {
  label: string;
  value: number;
  text: (value: number) => string;
  tone: 'key' | 'motion';
  /** While it is dragged. */
  onPreview?: (value: number) => void;
  onCommit: (value: number) => void;
}) {
  const id = useId();
  const shown = useSignal(props.value);
  useEffect(() => {
    shown.value = props.value;
  }, [props.value, shown]);
  const percent = Math.round(shown.value * 100);
  return (
    <div class={`slider tone-${props.tone}`}>
      <div class="slider-head">
        <label for={id}>{props.label}</label>
        <output for={id}>{percent}%</output>
      </div>
      <input
        id={id}
        type="range"
        min={0}
        max={100}
        step={1}
        value={percent}
        style={{ '--fill': `${percent}%` }}
        aria-describedby={`${id}-text`}
        onInput={(event) => {
          shown.value = Number(event.currentTarget.value) / 100;
          props.onPreview?.(shown.value);
        }}
        onChange={(event) => props.onCommit(Number(event.currentTarget.value) / 100)}
      />
      <p class="hint" id={`${id}-text`}>
        {props.text(shown.value)}
      </p>
    </div>
  );
}
