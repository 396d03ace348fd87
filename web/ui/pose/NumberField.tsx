/** A number that is typed; the step keys work at once, typing on Enter or on leaving. */
export function NumberField(props: {
  label: string;
  /** Shown before the number. */
  prefix?: string;
  tone?: string;
  value: number | null;
  step: number;
  min?: number;
  max?: number;
  onCommit: (value: number) => void;
}) {
  const text = props.value === null ? '' : String(Math.round(props.value * 10) / 10 + 0);
  return (
    <label class={`axis ${props.tone ?? ''}`}>
      {props.prefix ? <span aria-hidden="true">{props.prefix}</span> : null}
      <input
        type="number"
        aria-label={props.label}
        step={props.step}
        min={props.min}
        max={props.max}
        disabled={props.value === null}
        value={text}
        onChange={(event) => {
          const input = event.currentTarget;
          const value = Number(input.value);
          if (input.value !== '' && Number.isFinite(value))
            props.onCommit(Math.min(Math.max(value, props.min ?? -Infinity), props.max ?? Infinity));
          else input.value = text;
        }}
        onKeyDown={(event) => {
          if (event.key !== 'Escape' || event.currentTarget.value === text) return;
          // Esc takes back what was typed; only the next one leaves the editor.
          event.currentTarget.value = text;
          event.preventDefault();
        }}
      />
    </label>
  );
}
