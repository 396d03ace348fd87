import type { ComponentChildren } from 'preact';
import { useEffect, useRef } from 'preact/hooks';
import { Icon } from './Icon';

interface DialogProps {
  open: boolean;
  onClose: () => void;
  title: string;
  /** Id of the heading, which names the dialog. */
  titleId: string;
  /** Further classes of the dialog. */
  kind?: string;
  /** Class of what is inside. */
  bodyClass?: string;
  /** The page's keys rest while it is open. */
  keepsKeys?: boolean;
  /** Rendered only while it is open. */
  children: () => ComponentChildren;
}

/** A modal dialog of the browser's own, with a heading; left by its button, by Esc, or by a press beside it. */
export function Dialog(props: DialogProps) {
  const { open, onClose, title, titleId, kind = '', bodyClass = 'help-body', keepsKeys = false, children } = props;
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    if (open) dialog.current?.showModal();
    else dialog.current?.close();
  }, [open]);
  return (
    <dialog
      class={`help ${kind}`.trim()}
      ref={dialog}
      aria-labelledby={titleId}
      onClose={onClose}
      onClick={(event) => event.target === dialog.current && onClose()}
      onKeyDown={(event) => keepsKeys && event.stopPropagation()}
    >
      {open && (
        <div class={bodyClass}>
          <div class="help-head">
            <h2 id={titleId}>{title}</h2>
            <button type="button" class="tool" aria-label="Close" onClick={onClose}>
              <Icon name="close" />
            </button>
          </div>
          {children()}
        </div>
      )}
    </dialog>
  );
}
