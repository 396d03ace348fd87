import { useSignal } from '@preact/signals';
import { documentOnStage } from '../../app/on-stage';
import type { KeyError } from '../../core/report-curves';
import { CLOSE_ERROR, EXACT_ERROR } from '../../app/report-reference';
import { useStore } from '../store-context';
import { PosePicture } from '../thumbs';
import { errorText } from './verdicts';

/** Rows shown at first, and more at a press: a song may have a pose on every beat. */
const PAGE = 40;

/** Every key pose with its distance from the dance; a press goes there. */
export function KeyErrors({ errors }: { errors: readonly KeyError[] }) {
  const store = useStore();
  const shown = useSignal(PAGE);
  const { document, selection, onStage } = store.state;
  const keys = new Map(
    (onStage.value?.inputs?.keyPoses ?? documentOnStage(store.state).keyPoses).map((key) => [key.id, key]),
  );
  // Bars compare the poses with each other; exact ones have none, and all-but-exact ones stay short.
  const longest = Math.max(CLOSE_ERROR, ...errors.map((each) => each.error));
  const allExact = errors.every((each) => each.error < EXACT_ERROR);
  const go = (each: KeyError) => {
    store.seek(each.time);
    if (document.value.keyPoses.some((key) => key.id === each.id)) store.selectKey(each.id);
  };
  return (
    <>
      <ul class={`key-errors ${allExact ? 'exact' : ''}`} aria-label="Distance from each key pose">
        {errors.slice(0, shown.value).map((each) => {
          const pose = keys.get(each.id);
          const name = pose?.name ?? 'Key pose';
          const exact = each.error < EXACT_ERROR;
          return (
            <li key={each.id}>
              <button
                type="button"
                class={`key-error ${selection.value.has(each.id) ? 'chosen' : ''}`}
                aria-label={`${name} at ${each.time.toFixed(2)} seconds, ${exact ? 'exact' : `off by ${errorText(each.error)}`}: go there`}
                onClick={() => go(each)}
              >
                <span class="key-error-picture">{pose && <PosePicture rotations={pose.rotations} />}</span>
                <span class="key-error-name">{name}</span>
                <span class="key-error-time">{each.time.toFixed(1)} s</span>
                <span class="key-error-value">{exact ? 'exact' : errorText(each.error)}</span>
                {!allExact && (
                  <span class="key-error-bar">
                    <span style={{ width: `${exact ? 0 : Math.max(2, Math.sqrt(each.error / longest) * 100)}%` }} />
                  </span>
                )}
              </button>
            </li>
          );
        })}
      </ul>
      {errors.length > shown.value && (
        <button type="button" class="quiet" onClick={() => (shown.value += PAGE * 4)}>
          {errors.length - shown.value} more
        </button>
      )}
    </>
  );
}
