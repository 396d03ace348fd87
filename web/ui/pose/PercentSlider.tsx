/** A slider from `min` to 100 percent, with its value beside it. */
export function PercentSlider(props: {
  label: string;
  percent: number;
  min?: number;
  step?: number;
  disabled?: boolean;
  onInput: (percent: number) => void;
}) {
  const { label, percent, min = 0, step = 1, disabled = false, onInput } = props;
  return (
    <div class="slider-row tone-key">
      <input
        type="range"
        aria-label={label}
        aria-valuetext={`${percent} percent`}
        min={min}
        max={100}
        step={step}
        disabled={disabled}
        value={percent}
        style={{ '--fill': `${((percent - min) / (100 - min)) * 100}%` }}
        onInput={(event) => onInput(Number(event.currentTarget.value))}
      />
      <output>{percent}%</output>
    </div>
  );
}
