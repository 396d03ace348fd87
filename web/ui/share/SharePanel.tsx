import { useComputed, useSignal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import { embedSnippet } from '../../app/embed';
import { SAFE_LINK } from '../../app/actions/share';
import { messageOf } from '../../app/context';
import { isPlayed } from '../../core/formats/share-grid';
import { Icon } from '../Icon';
import { MovingPreview } from '../picture/MovingPreview';
import { leaveByEscape } from '../popover';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';

const PANEL_ID = 'share-panel';

/** The button that opens the panel, and the panel: the browser's own popover. */
export function Share() {
  const store = useStore();
  const { shareOpen } = store.state;
  const panel = useRef<HTMLDivElement>(null);
  const opener = useRef<HTMLButtonElement>(null);
  const open = shareOpen.value;
  useEffect(() => {
    if (open !== panel.current?.matches(':popover-open')) panel.current?.togglePopover(open);
    if (open) panel.current?.querySelector('button')?.focus();
  }, [open]);
  return (
    <>
      <button
        ref={opener}
        type="button"
        class="tool wide"
        aria-label="Share this dance"
        title={tip('share')}
        aria-haspopup="dialog"
        popovertarget={PANEL_ID}
      >
        <Icon name="share" />
      </button>
      <div
        id={PANEL_ID}
        class="menu project-menu share-panel"
        popover="auto"
        ref={panel}
        role="dialog"
        aria-labelledby="share-title"
        onKeyDown={(event) =>
          leaveByEscape(event, () => {
            store.toggleShare(false);
            opener.current?.focus();
          })
        }
        onToggle={(event) => store.toggleShare(event.newState === 'open')}
      >
        {open && <Panel />}
      </div>
    </>
  );
}

/** The link as far as there is one: made anew whenever the project changes under the open panel. */
function Panel() {
  const store = useStore();
  const { document, song, avatar } = store.state;
  const made = useComputed(() => {
    void document.value;
    try {
      return { link: store.shareLink(location.href), problem: '' };
    } catch (error) {
      return { link: '', problem: messageOf(error) };
    }
  });
  const { link, problem } = made.value;
  const played = document.value.grid !== null && isPlayed(document.value.grid);
  const name = song.value?.demo === false ? song.value.reference.name : null;
  return (
    <div class="share-body">
      <h2 id="share-title">Share this dance</h2>
      {problem ? (
        <>
          <p class="share-problem">
            <Icon name="warning" /> {problem}
          </p>
          <button type="button" class="secondary full" onClick={() => void store.saveProject(false)}>
            <Icon name="download" /> Save as a .posebeat file
          </button>
        </>
      ) : (
        <>
          <Copyable label="Link" text={link} action="Copy the link" />
          {'share' in navigator && <WebShare link={link} />}
          <p class="share-note">
            Everything is in the link itself: nothing is uploaded. Poses are rounded to about a degree
            {played ? ', beats played by hand to a millisecond' : ''}.
            {name &&
              ` The song is not in it: whoever opens it is asked for “${name}”, and sees the dance to the demo’s song until then.`}
            {avatar.value && ' Your own character stays here: others see Posebeat’s figure.'}
            {link.length > SAFE_LINK &&
              ` It has ${link.length.toLocaleString('en')} characters; some chat programs cut what is longer than ${SAFE_LINK.toLocaleString('en')}: a .posebeat file is safer there.`}
          </p>
          <MovingPreview />
          <Copyable label="For your own web page" text={embedSnippet(link)} action="Copy the code" />
        </>
      )}
    </div>
  );
}

/** A text that can be copied; where the browser forbids that, it is selected for the visitor to do so. */
function Copyable(props: { label: string; text: string; action: string }) {
  const store = useStore();
  const field = useRef<HTMLInputElement>(null);
  const done = useSignal(false);
  const copy = async () => {
    try {
      await navigator.clipboard.writeText(props.text);
      done.value = true;
      store.announce(`${props.label} copied.`);
      setTimeout(() => (done.value = false), 2500);
    } catch {
      field.current?.focus();
      field.current?.select();
      store.notify('info', 'This browser did not allow it: the text is selected, copy it with the keyboard.');
    }
  };
  return (
    <div class="share-copy">
      <button type="button" class="secondary" onClick={() => void copy()}>
        <Icon name={done.value ? 'check' : 'copy'} />
        {done.value ? 'Copied' : props.action}
      </button>
      <input
        type="text"
        readOnly
        ref={field}
        value={props.text}
        aria-label={props.label}
        onFocus={(event) => event.currentTarget.select()}
      />
    </div>
  );
}

/** The system's own way to send things. */
function WebShare({ link }: { link: string }) {
  const store = useStore();
  const send = async () => {
    try {
      await navigator.share({ title: 'A dance made with Posebeat', url: link });
    } catch (error) {
      // Turned down by the visitor, or by the system: the link is there to be copied.
      if (!(error instanceof DOMException && error.name === 'AbortError')) {
        store.notify('info', 'This device could not send it: copy the link instead.');
      }
    }
  };
  return (
    <button type="button" class="secondary full" onClick={() => void send()}>
      <Icon name="share" /> Send it…
    </button>
  );
}
