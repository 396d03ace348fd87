/** The beats of the song in their lane, to be dragged. */
export function BeatLane() {
  return null;
}
