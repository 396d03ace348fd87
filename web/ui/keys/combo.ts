/** Combinations of keys: which press is one, and how people read it. */
const mac = typeof navigator !== 'undefined' && /Mac|iPhone|iPad/.test(navigator.platform);

/** True when an event is one of a shortcut's keys. */
export function matches(
  event: Pick<KeyboardEvent, 'key' | 'ctrlKey' | 'metaKey' | 'shiftKey' | 'altKey'> & { code?: string },
  combo: string,
): boolean {
  const parts = combo.split('+').filter((part) => part !== '');
  const wanted = combo.endsWith('+') ? '+' : parts[parts.length - 1];
  const modifiers = combo.endsWith('+') ? parts : parts.slice(0, -1);
  if (event.altKey !== modifiers.includes('Alt')) return false;
  if ((event.ctrlKey || event.metaKey) !== modifiers.includes('Mod')) return false;
  const key = event.key === ' ' ? 'Space' : event.key;
  const named = wanted.length > 1 || /^[A-Z]$/.test(wanted);
  // With Shift a digit types another sign: the key itself tells.
  if (/^\d$/.test(wanted) && modifiers.includes('Shift')) return event.shiftKey && event.code === `Digit${wanted}`;
  if (!named) return key === wanted; // a printable sign: Shift is part of typing it
  if (event.shiftKey !== modifiers.includes('Shift')) return false;
  return key.toLowerCase() === wanted.toLowerCase();
}

/** The keys of a shortcut as people read them. */
export function keyText(combo: string): string {
  return combo
    .replace('Mod+', mac ? '⌘' : 'Ctrl+')
    .replace('Shift+', mac ? '⇧' : 'Shift+')
    .replace('Alt+', mac ? '⌥' : 'Alt+')
    .replace('ArrowLeft', '←')
    .replace('ArrowRight', '→')
    .replace('Escape', 'Esc');
}
