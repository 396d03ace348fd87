/** Ranges that were made anew, as chips with their takes. */
export function RangeLane() {
  return null;
}
