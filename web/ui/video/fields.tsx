/** Fields that a video and a picture are chosen by. */
import type { Signal } from '@preact/signals';
import { Segments } from '../export/Segments';

/** A size along the shorter edge, pixels. */
export function SizeField(props: {
  label: string;
  size: Signal<number>;
  sizes: readonly number[];
  text: (size: number) => string;
}) {
  const { label, size, sizes, text } = props;
  return (
    <label class="field video-size">
      <span>{label}</span>
      <select value={size.value} onChange={(event) => (size.value = Number(event.currentTarget.value))}>
        {sizes.map((each) => (
          <option key={each} value={each}>
            {text(each)}
          </option>
        ))}
      </select>
    </label>
  );
}

/** What is behind the dancer; a colour is chosen beside it. */
export function GroundField<T extends string>(props: {
  name: string;
  ground: Signal<T | 'colour'>;
  colour: Signal<string>;
  options: readonly { value: T | 'colour'; label: string; title?: string }[];
}) {
  const { name, ground, colour, options } = props;
  return (
    <div class="video-ground">
      <Segments
        legend="Background"
        name={name}
        value={ground.value}
        options={options}
        onChange={(value) => (ground.value = value)}
      />
      {ground.value === 'colour' && (
        <input
          type="color"
          aria-label="Colour of the background"
          value={colour.value}
          onInput={(event) => (colour.value = event.currentTarget.value)}
        />
      )}
    </div>
  );
}
