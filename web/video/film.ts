/** Films a dance: draws every frame at its own time, encodes it with the song and writes the file. Runs in a worker. */
import {
  AudioSample,
  AudioSampleSource,
  BufferTarget,
  CanvasSource,
  Mp4OutputFormat,
  Output,
  StreamTarget,
  WebMOutputFormat,
  type StreamTargetChunk,
} from 'mediabunny';
import { framePose } from '../core/motion';
import { FilmSet } from '../scene/filming';
import { cameraPath, FIELD_OF_VIEW } from './camera-path';
import { audioQuality, formatSupport, probe, videoQuality } from './codecs';
import { fitPath } from './dancer-path';
import { frameTime, type VideoFormat } from './options';
import type { EncoderWish, FilmRequest } from './protocol';
import { glowAt } from './shots';
import { planar, type Sound } from './sound';
import { chooseFormat, supportText } from './support-words';

/** Seconds of sound that are given to the encoder at once. */
const PIECE = 0.5;
/** Messages get a hearing this often, milliseconds. */
const BREATH = 80;

/** A file on disk that is written piece by piece; what is cancelled leaves nothing behind. */
class DiskFile {
  private kept = false;

  private constructor(private readonly file: FileSystemWritableFileStream) {}

  static async open(handle: FileSystemFileHandle): Promise<DiskFile> {
    return new DiskFile(await handle.createWritable());
  }

  get target(): StreamTarget {
    const writable = new WritableStream<StreamTargetChunk>({
      write: (chunk) => this.file.write(chunk as FileSystemWriteChunkType),
      // The library closes also what is cancelled: then the pieces must not become the file.
      close: () => (this.kept ? this.file.close() : this.file.abort()),
      abort: (reason) => this.file.abort(reason),
    });
    return new StreamTarget(writable, { chunked: true, chunkSize: 2 ** 22 });
  }

  keep(): void {
    this.kept = true;
  }
}

/** Gives the sound to its encoder little by little, never far ahead of the picture. */
class SoundTrack {
  readonly source: AudioSampleSource;
  private at = 0;

  constructor(
    private readonly sound: Sound,
    codec: NonNullable<Awaited<ReturnType<typeof formatSupport>>['audio']>,
  ) {
    this.source = new AudioSampleSource({ codec, quality: audioQuality() });
  }

  /** Everything up to a time of the video, seconds. */
  async upTo(seconds: number): Promise<void> {
    const { sampleRate, channels } = this.sound;
    const end = Math.min(channels[0].length, Math.round(seconds * sampleRate));
    while (this.at < end) {
      const to = Math.min(end, this.at + Math.round(PIECE * sampleRate));
      const sample = new AudioSample({
        data: planar(this.sound, this.at, to),
        format: 'f32-planar',
        numberOfChannels: channels.length,
        sampleRate,
        timestamp: this.at / sampleRate,
      });
      await this.source.add(sample);
      sample.close();
      this.at = to;
    }
  }
}

/**
 * Makes a video.
 * @param file where it goes; without it the bytes are returned
 * @param progress frames done so far
 * @throws Error with a message for people: no encoder, no WebGL, no room; AbortError when the signal fires
 */
export async function film(
  request: FilmRequest,
  file: FileSystemFileHandle | undefined,
  progress: (done: number) => void,
  signal: AbortSignal,
): Promise<{ format: VideoFormat; bytes?: ArrayBuffer }> {
  const { motion, plan, width, height, sound, grid } = request;
  const wish: EncoderWish = {
    width,
    height,
    fps: plan.fps,
    ...(sound ? { sound: { sampleRate: sound.sampleRate, channels: sound.channels.length } } : {}),
  };
  const support = await probe(wish);
  const format = chooseFormat(request.format, support);
  if (!format || (request.format && request.format !== format)) {
    throw new Error(supportText(request.format, format, support, sound !== null));
  }
  const codecs = await formatSupport(format, wish);
  signal.throwIfAborted();
  const canvas = new OffscreenCanvas(width, height);
  const set = await FilmSet.open(canvas, request.background, FIELD_OF_VIEW, request.look, request.avatar);
  let output: Output | null = null;
  try {
    const { camera, view } = request;
    const path = cameraPath(motion, plan, width / height, camera, grid, view);
    fitPath(path, set.dancerSize, camera === 'stage' ? view : null);
    signal.throwIfAborted();
    const disk = file && (await DiskFile.open(file));
    const target = disk ? disk.target : new BufferTarget();
    output = new Output({ format: format === 'mp4' ? new Mp4OutputFormat() : new WebMOutputFormat(), target });
    const picture = new CanvasSource(canvas, {
      codec: codecs.video!,
      quality: videoQuality(wish),
      keyFrameInterval: 2,
    });
    output.addVideoTrack(picture, { frameRate: plan.fps });
    const track = sound && codecs.audio ? new SoundTrack(sound, codecs.audio) : null;
    if (track) output.addAudioTrack(track.source);
    output.setMetadataTags({ title: request.title });
    await output.start();
    let pose: ReturnType<typeof framePose> | undefined;
    let breathed = performance.now();
    for (let frame = 0; frame < plan.frames; frame++) {
      const time = frameTime(plan, frame);
      pose = framePose(motion, time, pose);
      set.draw({
        pose,
        time,
        position: path.position.subarray(frame * 3, frame * 3 + 3),
        target: path.target.subarray(frame * 3, frame * 3 + 3),
        centre: path.centre.subarray(frame * 2, frame * 2 + 2),
        glow: glowAt(time, grid),
      });
      // The canvas is read at once, before the script yields; the promise only holds back what the encoder cannot take yet.
      const taken = picture.add(frame / plan.fps, 1 / plan.fps);
      await track?.upTo((frame + 1) / plan.fps + PIECE);
      await taken;
      if (performance.now() - breathed > BREATH) {
        progress(frame + 1);
        await new Promise((resolve) => setTimeout(resolve, 0));
        breathed = performance.now();
      }
      signal.throwIfAborted();
    }
    progress(plan.frames);
    disk?.keep();
    await output.finalize();
    return { format, ...(target instanceof BufferTarget ? { bytes: target.buffer! } : {}) };
  } catch (error) {
    await output?.cancel().catch(() => undefined);
    throw error;
  } finally {
    set.dispose();
  }
}
