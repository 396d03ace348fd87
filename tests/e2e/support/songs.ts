/** Songs that the tests make themselves: kick, hat, bass and chords on known beats. */

export interface SongOptions {
  seconds: number;
  tempo?: number;
  sampleRate?: number;
  channels?: 1 | 2;
  /** Peak level, 0..1; 0 is silence. */
  level?: number;
}

/** Interleaved samples, -1..1, of a four-on-the-floor song whose beats are at k x 60 / tempo seconds. */
export function synthesise({
  seconds,
  tempo = 120,
  sampleRate = 44100,
  channels = 1,
  level = 0.8,
}: SongOptions): Float32Array {
  const frames = Math.round(seconds * sampleRate);
  const beat = 60 / tempo;
  const chords = [
    [220, 261.63, 329.63],
    [174.61, 220, 261.63],
    [261.63, 329.63, 392],
    [196, 246.94, 293.66],
  ];
  const out = new Float32Array(frames * channels);
  let noise = 1;
  for (let i = 0; i < frames; i++) {
    const t = i / sampleRate;
    const index = Math.floor(t / beat);
    const since = t - index * beat;
    const accent = index % 4 === 0 ? 1 : 0.7;
    const kick =
      accent * Math.sin(2 * Math.PI * (50 * since + (30 * (1 - Math.exp(-since * 30))) / 30)) * Math.exp(-since * 12);
    noise = (noise * 16807) % 2147483647;
    const offbeat = Math.abs(since - beat / 2);
    const hat = since >= beat / 2 ? (noise / 1073741824 - 1) * 0.3 * Math.exp(-offbeat * 60) : 0;
    const chord = chords[Math.floor(index / 4) % chords.length];
    const pad = chord.reduce((sum, hertz) => sum + Math.sin(2 * Math.PI * hertz * t), 0) * 0.08;
    const bass = Math.sin(2 * Math.PI * (chord[0] / 2) * t) * 0.2 * Math.exp(-since * 4);
    const sample = level * Math.max(-1, Math.min(1, (kick + hat + pad + bass) * 0.7));
    for (let c = 0; c < channels; c++) out[i * channels + c] = sample;
  }
  return out;
}

/** A 16-bit PCM WAV file. */
export function wav(options: SongOptions): Buffer {
  const { sampleRate = 44100, channels = 1 } = options;
  const samples = synthesise(options);
  const data = Buffer.alloc(44 + samples.length * 2);
  data.write('RIFF', 0);
  data.writeUInt32LE(36 + samples.length * 2, 4);
  data.write('WAVEfmt ', 8);
  data.writeUInt32LE(16, 16);
  data.writeUInt16LE(1, 20);
  data.writeUInt16LE(channels, 22);
  data.writeUInt32LE(sampleRate, 24);
  data.writeUInt32LE(sampleRate * channels * 2, 28);
  data.writeUInt16LE(channels * 2, 32);
  data.writeUInt16LE(16, 34);
  data.write('data', 36);
  data.writeUInt32LE(samples.length * 2, 40);
  samples.forEach((sample, i) => data.writeInt16LE(Math.round(sample * 32767), 44 + i * 2));
  return data;
}
