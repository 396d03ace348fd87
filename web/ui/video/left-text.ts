/** How long something still takes, for people: rounded so that it does not flicker. */
export function leftText(seconds: number | null, ending = false): string {
  if (ending) return 'Writing the end of the file';
  if (seconds === null) return 'Getting ready';
  if (seconds < 5) return 'A few seconds left';
  if (seconds < 55) return `About ${Math.ceil(seconds / 5) * 5} seconds left`;
  if (seconds < 90) return 'About a minute left';
  return `About ${Math.round(seconds / 60)} minutes left`;
}
