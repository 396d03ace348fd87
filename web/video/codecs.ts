/** Which encoders this browser has. */
import { canEncodeAudio, canEncodeVideo, Quality, type AudioCodec, type VideoCodec } from 'mediabunny';
import { AUDIO_BITRATE, VIDEO_FORMATS, videoBitrate, type VideoFormat } from './options';
import type { EncoderWish, FormatSupport, VideoSupport } from './protocol';

/** What each format may hold, what plays in the most places first. */
const CODECS: Readonly<Record<VideoFormat, { video: readonly VideoCodec[]; audio: readonly AudioCodec[] }>> = {
  mp4: { video: ['avc', 'hevc', 'av1'], audio: ['aac', 'opus'] },
  webm: { video: ['vp9', 'vp8', 'av1'], audio: ['opus', 'vorbis'] },
};

/** The quality that is asked for. */
export const videoQuality = ({ width, height, fps }: EncoderWish): Quality =>
  new Quality({ bitrate: videoBitrate(width, height, fps), bitrateMode: 'variable' });

/** The sound's quality. */
export const audioQuality = (): Quality => new Quality({ bitrate: AUDIO_BITRATE });

async function first<T>(codecs: readonly T[], can: (codec: T) => Promise<boolean>): Promise<T | null> {
  for (const codec of codecs) if (await can(codec)) return codec;
  return null;
}

/** What this browser would make a format with. */
export async function formatSupport(
  format: VideoFormat,
  wish: EncoderWish,
): Promise<{ video: VideoCodec | null; audio: AudioCodec | null }> {
  const { width, height, fps, sound } = wish;
  const { video, audio } = CODECS[format];
  const picture = { width, height, frameRate: fps, quality: videoQuality(wish) };
  return {
    video: await first(video, (codec) => canEncodeVideo(codec, picture)),
    audio: sound
      ? await first(audio, (codec) =>
          canEncodeAudio(codec, {
            sampleRate: sound.sampleRate,
            numberOfChannels: sound.channels,
            quality: audioQuality(),
          }),
        )
      : null,
  };
}

/** What this browser can make of a picture and a sound. */
export async function probe(wish: EncoderWish): Promise<VideoSupport> {
  const entries = await Promise.all(
    VIDEO_FORMATS.map(async (format) => [format, await formatSupport(format, wish)] as const),
  );
  return {
    any: typeof VideoEncoder !== 'undefined' && typeof OffscreenCanvas !== 'undefined',
    formats: Object.fromEntries(entries) as Record<VideoFormat, FormatSupport>,
  };
}
