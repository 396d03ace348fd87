import { useRef } from 'preact/hooks';
import { Icon } from './Icon';
import { UpdateNotice } from './share/UpdateNotice';
import { useStore } from './store-context';

/** Messages to the visitor; errors stay until dismissed. */
export function Notices() {
  const store = useStore();
  const region = useRef<HTMLDivElement>(null);
  /** Where the keyboard was before it came here. */
  const before = useRef<HTMLElement | null>(null);

  /** Takes a message away; a keyboard that was in it goes to the next one, and back from the last. */
  const dismiss = (id: number, button: HTMLElement) => {
    const all = [...region.current!.querySelectorAll<HTMLElement>('.dismiss')];
    const own = button.closest('.notice')!;
    const held = own.contains(document.activeElement);
    const other = all.filter((each) => !own.contains(each));
    const next =
      other.find((each) => own.compareDocumentPosition(each) & Node.DOCUMENT_POSITION_FOLLOWING) ?? other.at(-1);
    store.dismiss(id);
    if (held) (next ?? before.current)?.focus();
  };

  return (
    <>
      <div
        class="notices"
        role="region"
        aria-label="Messages"
        ref={region}
        onFocusCapture={({ relatedTarget }) => {
          if (relatedTarget instanceof HTMLElement && !region.current!.contains(relatedTarget))
            before.current = relatedTarget;
        }}
      >
        {store.state.elsewhere.value && (
          <div class="notice info elsewhere" role="status">
            <Icon name="info" />
            <span>This project is open in another tab. What you change here is not kept.</span>
            <button type="button" class="secondary" onClick={() => void store.workHere()}>
              Work here
            </button>
          </div>
        )}
        <UpdateNotice />
        {store.state.notices.value.map(({ id, kind, text, action }) => (
          <div key={id} class={`notice ${kind}`} role={kind === 'error' ? 'alert' : 'status'}>
            <Icon name={kind === 'error' ? 'warning' : 'info'} />
            <span>{text}</span>
            {action && (
              <button
                type="button"
                class="secondary"
                onClick={({ currentTarget }) => {
                  dismiss(id, currentTarget);
                  action.run();
                }}
              >
                {action.label}
              </button>
            )}
            <button
              type="button"
              class="tool dismiss"
              aria-label="Dismiss"
              onClick={({ currentTarget }) => dismiss(id, currentTarget)}
            >
              <Icon name="close" size={16} />
            </button>
          </div>
        ))}
      </div>
      <div class="visually-hidden" aria-live="polite">
        {store.state.announcement.value}
      </div>
    </>
  );
}
