import { Icon } from './Icon';
import { UpdateNotice } from './share/UpdateNotice';
import { useStore } from './store-context';

/** Messages to the visitor; errors stay until dismissed. */
export function Notices() {
  const store = useStore();
  return (
    <>
      <div class="notices" role="region" aria-label="Messages">
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
                onClick={() => {
                  store.dismiss(id);
                  action.run();
                }}
              >
                {action.label}
              </button>
            )}
            <button type="button" class="tool" aria-label="Dismiss" onClick={() => store.dismiss(id)}>
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
