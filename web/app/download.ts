/** Files for the visitor to keep. */

/** Offers a blob as a download. */
export function saveFile(blob: Blob, name: string): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** A file's name without what file systems dislike. */
export function fileName(title: string, extension: string): string {
  const plain = title
    .replace(/\.[a-z0-9]{2,5}$/i, '')
    .replace(/[^\p{L}\p{N} _-]/gu, '')
    .trim();
  return `${plain || 'dance'}.${extension}`;
}
