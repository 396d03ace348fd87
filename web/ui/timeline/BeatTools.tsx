/** Tools of the beat grid in the timeline's bar. */
export function BeatTools() {
  return null;
}
