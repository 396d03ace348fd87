import type { ComponentChildren } from 'preact';
import { Icon } from '../Icon';

/** A section that is folded away until it is wanted. */
export function Fold(props: { title: string; summary?: string; children: ComponentChildren }) {
  return (
    <details class="fold">
      <summary>
        <Icon name="chevronRight" size={16} />
        <span>{props.title}</span>
        {props.summary && <small>{props.summary}</small>}
      </summary>
      <div class="fold-body">{props.children}</div>
    </details>
  );
}
