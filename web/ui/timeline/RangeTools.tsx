/** What can be done with the selected range, in the timeline's bar. */
export function RangeTools() {
  return null;
}
