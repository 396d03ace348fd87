import { Icon, type IconName } from './Icon';

interface Props {
  icon: IconName;
  /** The button's name; it has no text. */
  label: string;
  /** What the pointer is told; missing = the name. */
  title?: string;
  /** CSS pixels. */
  size?: number;
  /** For a button that is on or off. */
  pressed?: boolean;
  disabled?: boolean;
  class?: string;
  onClick(): void;
}

/** A button with nothing but an icon on it. */
export function ToolButton({
  icon,
  label,
  title = label,
  size,
  pressed,
  disabled,
  class: look = 'tool',
  onClick,
}: Props) {
  return (
    <button
      type="button"
      class={look}
      disabled={disabled}
      aria-pressed={pressed}
      aria-label={label}
      title={title}
      onClick={onClick}
    >
      <Icon name={icon} size={size} />
    </button>
  );
}
