/** The two ends of the part of the song that is danced to. */
export function TrimHandles() {
  return null;
}
