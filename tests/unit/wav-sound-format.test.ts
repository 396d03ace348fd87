import { describe, expect, it } from 'vitest';
import { sniffSound } from '../../web/core/sound-format';
import { decodeWav, mixToMono } from '../../web/core/wav';
import { WaveformBuilder } from '../../web/core/waveform';

const text = (s: string): number[] => [...s].map((c) => c.charCodeAt(0));
const le = (value: number, bytes: number): number[] =>
  Array.from({ length: bytes }, (_, i) => (value >>> (8 * i)) & 255);
const be = (value: number, bytes: number): number[] => le(value, bytes).reverse();

function wav(format: number, bits: number, channels: number, data: number[], rate = 22050): Uint8Array {
  const block = (channels * bits) / 8;
  const head = [
    ...text('RIFF'),
    ...le(36 + data.length, 4),
    ...text('WAVE'),
    ...text('fmt '),
    ...le(16, 4),
    ...le(format, 2),
  ];
  const rest = [...le(channels, 2), ...le(rate, 4), ...le(rate * block, 4), ...le(block, 2), ...le(bits, 2)];
  return Uint8Array.from([...head, ...rest, ...text('data'), ...le(data.length, 4), ...data]);
}

describe('decodeWav', () => {
  it('reads every usual sample format', () => {
    expect([...decodeWav(wav(1, 8, 1, [0, 128, 192])).channels[0]]).toEqual([-1, 0, 0.5]);
    expect([...decodeWav(wav(1, 16, 1, [...le(0x4000, 2), ...le(0x8000, 2)])).channels[0]]).toEqual([0.5, -1]);
    expect([...decodeWav(wav(1, 24, 1, [...le(0x400000, 3), ...le(0xc00000, 3)])).channels[0]]).toEqual([0.5, -0.5]);
    expect([...decodeWav(wav(1, 32, 1, le(0x40000000, 4))).channels[0]]).toEqual([0.5]);
    const float = [...new Uint8Array(new Float32Array([0.25, -0.75]).buffer)];
    const stereo = decodeWav(wav(3, 32, 2, float, 48000));
    expect(stereo.sampleRate).toBe(48000);
    expect(stereo.channels.map((c) => [...c])).toEqual([[0.25], [-0.75]]);
    expect([...mixToMono(stereo.channels)]).toEqual([-0.25]);
  });

  it('says what is wrong', () => {
    expect(() => decodeWav(Uint8Array.from(text('hello world!')))).toThrow('Not a wav file.');
    expect(() => decodeWav(wav(17, 4, 1, [1, 2]))).toThrow('not supported');
    expect(() => decodeWav(wav(1, 16, 1, []).subarray(0, 36))).toThrow('no sound data');
  });
});

describe('sniffSound', () => {
  const sniff = (bytes: number[]) => sniffSound(Uint8Array.from(bytes));

  it('knows wav, its rate and its length', () => {
    const file = wav(1, 16, 2, new Array<number>(88200).fill(0), 44100);
    expect(sniffSound(file)).toEqual({
      kind: 'wav',
      sampleRate: 44100,
      duration: 0.5,
      isProtected: false,
      isTruncated: false,
    });
    expect(sniffSound(file.subarray(0, 5000)).isTruncated).toBe(true);
  });

  it('knows flac, its rate and its length', () => {
    const rateAndCount = [...be((48000 << 12) >>> 0, 4).slice(0, 3), 0xf0, ...be(96000, 4)];
    const found = sniff([
      ...text('fLaC'),
      0,
      0,
      0,
      34,
      ...new Array<number>(10).fill(0),
      ...rateAndCount,
      ...new Array<number>(16).fill(0),
    ]);
    expect(found.kind).toBe('flac');
    expect(found.sampleRate).toBe(48000);
    expect(found.duration).toBe(2);
  });

  it('knows ogg, and that its last page is cut', () => {
    const body = [1, ...text('vorbis'), ...le(0, 4), 2, ...le(32000, 4), ...new Array<number>(14).fill(0)];
    const page = [...text('OggS'), ...new Array<number>(22).fill(0), 1, body.length, ...body];
    expect(sniff(page)).toMatchObject({ kind: 'ogg', sampleRate: 32000, isTruncated: false });
    expect(sniff(page.slice(0, -3)).isTruncated).toBe(true);
  });

  it('knows mp3 with and without a tag, and that sound is missing', () => {
    const frame = [0xff, 0xfb, 0x90, 0x64, ...new Array<number>(32).fill(0)];
    expect(sniff(frame)).toMatchObject({ kind: 'mp3', sampleRate: 44100, isTruncated: false });
    expect(sniff([...text('ID3'), 4, 0, 0, 0, 0, 0, 5, 0, 0, 0, 0, 0, ...frame]).sampleRate).toBe(44100);
    expect(sniff([...text('ID3'), 4, 0, 0, 0, 0, 100, 5, 1]).isTruncated).toBe(true);
    const info = [...frame, ...text('Xing'), ...be(3, 4), ...be(1000, 4), ...be(50000, 4)];
    expect(sniff(info).isTruncated).toBe(true);
    expect(sniff(info).duration).toBeCloseTo((1000 * 1152) / 44100, 6);
  });

  it('knows m4a, protected m4a and one without its index', () => {
    const box = (name: string, body: number[]): number[] => [...be(8 + body.length, 4), ...text(name), ...body];
    const ftyp = (brand: string): number[] => box('ftyp', [...text(brand), 0, 0, 0, 0]);
    const entry = (name: string): number[] => [...text(name), ...new Array<number>(24).fill(0), ...be(44100, 2), 0, 0];
    const moov = (name: string): number[] => box('moov', [...text('soun'), ...entry(name)]);
    expect(sniff([...ftyp('M4A '), ...moov('mp4a')])).toMatchObject({
      kind: 'm4a',
      sampleRate: 44100,
      isProtected: false,
    });
    expect(sniff([...ftyp('M4A '), ...moov('drms')]).isProtected).toBe(true);
    expect(sniff([...ftyp('M4P '), ...moov('mp4a')]).isProtected).toBe(true);
    expect(sniff(ftyp('M4A ')).isTruncated).toBe(true);
    expect(sniff([...ftyp('M4A '), ...moov('mp4a').slice(0, 20)]).isTruncated).toBe(true);
    expect(sniff([...ftyp('mp42'), ...box('moov', text('vide'))]).other).toContain('video');
  });

  it('names what people drop by mistake', () => {
    expect(sniff([0x89, ...text('PNG')]).other).toBe('a picture');
    expect(sniff(text('%PDF-1.7')).other).toBe('a PDF document');
    expect(sniff(text('MThd')).other).toContain('MIDI');
    expect(sniff(text('just some words'))).toEqual({ kind: null, isProtected: false, isTruncated: false });
    expect(sniff([])).toEqual({ kind: null, isProtected: false, isTruncated: false });
  });
});

describe('WaveformBuilder', () => {
  it('keeps the extremes of each hundredth of a second', () => {
    const builder = new WaveformBuilder(400, 10);
    builder.push(Float32Array.from([0.1, -0.2, 0.3, 0, 0.5]));
    builder.push(Float32Array.from([-0.6, 0.2, 0.1, 0.7, -0.1]));
    const { rate, min, max } = builder.snapshot();
    expect(rate).toBe(100);
    expect([...min].map((v) => Number(v.toFixed(3)))).toEqual([-0.2, -0.6, -0.1]);
    expect([...max].map((v) => Number(v.toFixed(3)))).toEqual([0.3, 0.5, 0.7]);
  });
});
