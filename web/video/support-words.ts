/** What a browser can and cannot make, in plain words. Pure: no DOM. */
import { VIDEO_FORMATS, type VideoFormat } from './options';
import type { VideoSupport } from './protocol';

/** What is said where nothing can be made. */
export const NO_VIDEO =
  'This browser cannot make videos: it has no video encoder (WebCodecs). A current Chrome, Edge, Firefox or Safari has one; your dance can be opened there from its .posebeat file.';

/** Names of the formats for people. */
export const FORMAT_NAMES: Readonly<Record<VideoFormat, string>> = { mp4: 'MP4', webm: 'WebM' };

const CODEC_NAMES: Readonly<Record<string, string>> = {
  avc: 'H.264',
  hevc: 'H.265',
  av1: 'AV1',
  vp9: 'VP9',
  vp8: 'VP8',
  aac: 'AAC',
  opus: 'Opus',
  vorbis: 'Vorbis',
};

/** The format that is made for a wish: the wished one where the browser can, else one that it can; null = none. */
export function chooseFormat(wished: VideoFormat | null, { any, formats }: VideoSupport): VideoFormat | null {
  if (!any) return null;
  const order = wished ? [wished, ...VIDEO_FORMATS.filter((format) => format !== wished)] : VIDEO_FORMATS;
  return order.find((format) => formats[format].video !== null) ?? null;
}

/** What is in a file, such as “H.264 and AAC”. */
export function contentsText(format: VideoFormat, { formats }: VideoSupport): string {
  const { video, audio } = formats[format];
  const names = [video, audio].flatMap((codec) => (codec ? [CODEC_NAMES[codec] ?? codec] : []));
  return names.join(' and ');
}

/**
 * What the visitor should know before a video is made; empty where all is well.
 * @param made what {@link chooseFormat} chose
 * @param sound whether sound is wanted
 */
export function supportText(
  wished: VideoFormat | null,
  made: VideoFormat | null,
  support: VideoSupport,
  sound: boolean,
): string {
  if (!support.any) return NO_VIDEO;
  if (!made) return 'This size is more than this browser’s video encoders take: choose a smaller one.';
  const said: string[] = [];
  if (wished && made !== wished) {
    said.push(
      `This browser has no encoder for ${FORMAT_NAMES[wished]} of this size: it makes ${FORMAT_NAMES[made]} instead.`,
    );
  }
  const { audio } = support.formats[made];
  if (sound && !audio) {
    const other = VIDEO_FORMATS.find((format) => support.formats[format].video && support.formats[format].audio);
    said.push(
      other
        ? `This browser has no sound encoder for ${FORMAT_NAMES[made]}, so it would be silent: ${FORMAT_NAMES[other]} has the song.`
        : 'This browser has no sound encoder, so the video is silent: a current Chrome, Edge or Firefox adds the song.',
    );
  } else if (sound && made === 'mp4' && audio !== 'aac') {
    said.push(
      `This browser has no AAC encoder, so the sound is ${CODEC_NAMES[audio!] ?? audio}: browsers, VLC and YouTube play it, some other players do not.`,
    );
  }
  return said.join(' ');
}
