import { describe, expect, it } from 'vitest';
import {
  framePlan,
  frameTime,
  timeLeft,
  videoBytes,
  videoSettings,
  videoSize,
  ASPECTS,
  VIDEO_SIZES,
} from '../../web/video/options';
import { planar, soundOf } from '../../web/video/sound';
import { chooseFormat, NO_VIDEO, supportText } from '../../web/video/support-words';
import type { VideoSupport } from '../../web/video/protocol';

describe('sizes', () => {
  it('are what the names say, and even', () => {
    expect(videoSize('16:9', 720)).toEqual({ width: 1280, height: 720 });
    expect(videoSize('9:16', 1080)).toEqual({ width: 1080, height: 1920 });
    expect(videoSize('1:1', 1080)).toEqual({ width: 1080, height: 1080 });
    expect(videoSize('16:9', 180)).toEqual({ width: 320, height: 180 });
    for (const aspect of ASPECTS)
      for (const size of VIDEO_SIZES) {
        const { width, height } = videoSize(aspect, size);
        expect([width % 2, height % 2]).toEqual([0, 0]);
        expect(Math.min(width, height)).toBe(size);
      }
  });
});

describe('options', () => {
  it('are filled in', () => {
    expect(videoSettings({})).toEqual({
      format: null,
      aspect: '16:9',
      size: 720,
      fps: 30,
      camera: 'follow',
      background: 'stage',
      sound: true,
    });
  });

  it.each([
    [{ aspect: '4:3' }, /aspect must be one of "16:9", "1:1", "9:16"/],
    [{ size: 700 }, /size must be one of 180, 360, 720/],
    [{ fps: 25 }, /fps must be one of 30, 60/],
    [{ camera: 'drone' }, /camera must be one of/],
    [{ format: 'avi' }, /format must be one of "mp4", "webm"/],
    [{ background: 'green' }, /#00b140/],
  ])('%j is refused with what it can be', (options, message) => {
    expect(() => videoSettings(options as never)).toThrow(message);
  });
});

describe('frames', () => {
  it('are at exact times of the song', () => {
    const plan = framePlan({ start: 12.345, end: 14.345 }, 60);
    expect(plan.frames).toBe(120);
    expect(frameTime(plan, 0)).toBe(12.345);
    expect(frameTime(plan, 119)).toBeCloseTo(12.345 + 119 / 60, 12);
  });

  it('are one at least, and no more than an hour of them', () => {
    expect(framePlan({ start: 1, end: 1.001 }, 30).frames).toBe(1);
    expect(() => framePlan({ start: 0, end: 3601 }, 30)).toThrow(/an hour/);
  });

  it('tell how long the rest takes, and how large it gets', () => {
    expect(timeLeft(0.5, 10, 100)).toBeNull();
    expect(timeLeft(10, 50, 200)).toBe(30);
    const minute = framePlan({ start: 0, end: 60 }, 30);
    expect(videoBytes(1280, 720, minute, true)).toBeGreaterThan(2 * videoBytes(640, 360, minute, true));
  });
});

describe('the sound', () => {
  const sampleRate = 1000;
  const song = (channels: number, length = 5000) => ({
    sampleRate,
    length,
    numberOfChannels: channels,
    // Every sample says where it is from.
    getChannelData: (channel: number) => Float32Array.from({ length }, (_, i) => 1 + i + channel * 10_000),
  });

  it('begins with the sample of the first frame and lasts as long as the frames', () => {
    const { channels } = soundOf(song(2), framePlan({ start: 1.5, end: 3.5 }, 30));
    expect(channels.map(({ length }) => length)).toEqual([2000, 2000]);
    // Past the fade of a cut song every sample is the song's own.
    for (const i of [8, 100, 1000, 1991]) expect([channels[0][i], channels[1][i]]).toEqual([1501 + i, 11_501 + i]);
    expect(channels[0][0]).toBe(0);
    expect(channels[0][1999]).toBe(0);
    expect(channels[0][1996]).toBeLessThan(channels[0][1990]);
  });

  it('is not faded where the song itself begins and ends, and silent beyond', () => {
    const [samples] = soundOf(song(1), framePlan({ start: 0, end: 6 }, 30)).channels;
    expect([samples[0], samples[4999], samples[5000], samples[5999]]).toEqual([1, 5000, 0, 0]);
  });

  it('has two channels at most, one after the other', () => {
    const sound = soundOf(song(6), framePlan({ start: 0, end: 5 }, 30));
    expect(sound.channels).toHaveLength(2);
    expect([...planar(sound, 10, 12)]).toEqual([11, 12, 10_011, 10_012]);
  });
});

describe('what a browser can make', () => {
  const none = { video: null, audio: null };
  const webm = { video: 'vp9', audio: 'opus' };
  const support = (mp4: VideoSupport['formats']['mp4'], other = webm, any = true): VideoSupport => ({
    any,
    formats: { mp4, webm: other },
  });

  it('is made as wished, without a word', () => {
    const all = support({ video: 'avc', audio: 'aac' });
    expect(chooseFormat(null, all)).toBe('mp4');
    expect(chooseFormat('webm', all)).toBe('webm');
    expect(supportText('mp4', 'mp4', all, true)).toBe('');
  });

  it('is the other format where one is missing, and says so', () => {
    const only = support(none);
    expect(chooseFormat('mp4', only)).toBe('webm');
    expect(supportText('mp4', 'webm', only, true)).toMatch(/no encoder for MP4.*makes WebM instead/);
  });

  it('names a missing sound encoder, and which format has the song', () => {
    expect(supportText('mp4', 'mp4', support({ video: 'avc', audio: null }), true)).toMatch(
      /silent: WebM has the song/,
    );
    expect(supportText('mp4', 'mp4', support({ video: 'avc', audio: null }), false)).toBe('');
    expect(supportText('mp4', 'mp4', support({ video: 'avc', audio: 'opus' }), true)).toMatch(/no AAC.*Opus/);
  });

  it('is nothing without encoders', () => {
    const nothing = support(none, none as never, false);
    expect(chooseFormat('mp4', nothing)).toBeNull();
    expect(supportText('mp4', null, nothing, true)).toBe(NO_VIDEO);
    expect(supportText('mp4', null, support(none, none as never), true)).toMatch(/choose a smaller one/);
  });
});
