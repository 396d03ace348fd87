import { useRef } from 'preact/hooks';
import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';
import { SuggestMenu, SUGGEST_MENU_ID } from './SuggestMenu';

/** Suggesting key poses, in the timeline's bar: the button, its settings, and while it works how far it is. */
export function SuggestTools() {
  const store = useStore();
  const settings = useRef<HTMLButtonElement>(null);
  const { suggestion, song } = store.state;
  const off = !song.value?.complete;
  if (suggestion.value.status !== 'idle') {
    return (
      <div class="bar-group suggest-tools">
        <SuggestProgress />
      </div>
    );
  }
  return (
    <div class="bar-group suggest-tools" role="group" aria-label="Suggested key poses">
      <button
        type="button"
        class="bar-button framed suggest"
        disabled={off}
        title={tip('suggest', 'Suggest key poses on the beats; your own stay as they are')}
        onPointerEnter={() => off || store.warmSuggester()}
        onFocus={() => off || store.warmSuggester()}
        onClick={() => void store.suggestForPage()}
      >
        <Icon name="sparkles" size={16} />
        Suggest
      </button>
      <button
        type="button"
        class="bar-button"
        ref={settings}
        disabled={off}
        popovertarget={SUGGEST_MENU_ID}
        aria-haspopup="dialog"
        aria-label="What to suggest"
        title="How many poses, where, how bold"
      >
        <Icon name="chevronDown" size={14} />
      </button>
      <SuggestMenu opener={settings} />
    </div>
  );
}

/** How far the suggestions are; pressed, it stops them. */
export function SuggestProgress() {
  const store = useStore();
  const at = store.state.suggestion.value;
  if (at.status === 'idle') return null;
  const percent = Math.round(at.fraction * 100);
  const text = at.status === 'loading' ? 'Getting ready' : `${at.poses} pose${at.poses === 1 ? '' : 's'}`;
  return (
    <button
      type="button"
      class="bar-button framed suggest busy"
      aria-label={`Stop suggesting, ${text}`}
      title="Stop; the timeline goes back to what it was"
      onClick={() => store.cancelSuggestion()}
    >
      <span class="suggest-fill" style={{ width: `${percent}%` }} />
      <Icon name="close" size={16} />
      <span class="tabular">{text}</span>
    </button>
  );
}
