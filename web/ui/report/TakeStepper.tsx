import { Icon } from '../Icon';
import { useStore } from '../store-context';

const HIGHEST = 2 ** 31 - 1;

/** Which take: the same number always gives the same dance. */
export function TakeStepper() {
  const store = useStore();
  const { seed } = store.state.document.value.dials;
  const show = (next: number) => void store.showTake(Math.min(HIGHEST, Math.max(0, next)));
  return (
    <div class="take" role="group" aria-label="Take">
      <label class="take-number">
        <span>Take</span>
        <input
          type="number"
          min={0}
          max={HIGHEST}
          step={1}
          value={String(seed)}
          onChange={(event) => {
            const next = Number(event.currentTarget.value);
            const valid = event.currentTarget.value !== '' && Number.isInteger(next) && next >= 0 && next <= HIGHEST;
            if (valid) show(next);
            else event.currentTarget.value = String(seed);
          }}
        />
      </label>
      <button
        type="button"
        class="tool"
        disabled={seed <= 0}
        aria-label="Previous take"
        title="Previous take"
        onClick={() => show(seed - 1)}
      >
        <Icon name="chevronLeft" />
      </button>
      <button
        type="button"
        class="tool"
        disabled={seed >= HIGHEST}
        aria-label="Next take"
        title="Next take"
        onClick={() => show(seed + 1)}
      >
        <Icon name="chevronRight" />
      </button>
      <button
        type="button"
        class="secondary"
        title="Another take at random: the same poses, another dance"
        onClick={() => show(otherThan(seed))}
      >
        <Icon name="dices" />
        Another take
      </button>
      <p class="hint">The same number always gives the same dance.</p>
    </div>
  );
}

function otherThan(seed: number): number {
  const next = 1 + Math.floor(Math.random() * 9998);
  return next === seed ? 9999 : next;
}
