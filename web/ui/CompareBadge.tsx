import { Icon } from './Icon';
import { tip } from './shortcuts';
import { useStore } from './store-context';

/** Over the stage while two dances are compared: which one is seen, and the ways out. */
export function CompareBadge() {
  const store = useStore();
  const held = store.state.compare.value;
  if (!held || store.state.draft.value) return null;
  const { shown } = held;
  return (
    <div class="compare-badge" role="group" aria-label="Compare two dances">
      <div class="compare-sides" role="radiogroup" aria-label="On stage">
        {(['a', 'b'] as const).map((side) => (
          <label
            key={side}
            title={tip('compare', side === 'a' ? 'A: the dance you held' : 'B: the dance as it is now')}
          >
            <input
              type="radio"
              class="visually-hidden"
              name="compare"
              aria-label={side === 'a' ? 'A, the dance you held' : 'B, the dance of now'}
              checked={shown === side}
              onChange={() => store.showCompared(side)}
            />
            <span aria-hidden="true">{side.toUpperCase()}</span>
          </label>
        ))}
      </div>
      <button
        type="button"
        class="quiet"
        aria-pressed={held.beside === true}
        title="A on the left, B on the right, at the same time"
        onClick={() => store.toggleBeside()}
      >
        Side by side
      </button>
      {shown === 'a' ? (
        <button
          type="button"
          class="quiet"
          title="Goes back to the project as it was with A; undo brings B back"
          onClick={() => store.keepHeld()}
        >
          Go back to A
        </button>
      ) : (
        <button type="button" class="quiet" title="Holds the dance of now as A" onClick={() => store.holdAgain()}>
          Hold B as A
        </button>
      )}
      <button
        type="button"
        class="tool"
        aria-label="End the comparison"
        title="End the comparison; the dance of now (B) stays"
        onClick={() => store.leaveCompare()}
      >
        <Icon name="close" size={16} />
      </button>
    </div>
  );
}
