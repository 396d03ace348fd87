import { signal, useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { clockTime } from '../../app/snapping';
import {
  videoBytes,
  videoSize,
  VIDEO_SIZES,
  type VideoAspect,
  type VideoCamera,
  type VideoFormat,
  type VideoOptions,
} from '../../video/options';
import type { VideoSupport } from '../../video/protocol';
import { chooseFormat, contentsText, FORMAT_NAMES, NO_VIDEO, supportText } from '../../video/support-words';
import { sizeText } from '../export/formats';
import { PARTS, partsNow, type Part } from '../export/parts';
import { Segments } from '../export/Segments';
import { Icon } from '../Icon';
import { useStore } from '../store-context';
import { GroundField, SizeField } from './fields';
import { NoVideo } from './NoVideo';
import { takeFocus, VideoProgress } from './VideoProgress';

/** What was chosen last; it stays while the page is open. */
const choice = {
  format: signal<VideoFormat>('mp4'),
  aspect: signal<VideoAspect>('16:9'),
  size: signal(720),
  fps: signal(30),
  camera: signal<VideoCamera>('follow'),
  ground: signal<'stage' | 'colour'>('stage'),
  colour: signal('#00b140'),
  part: signal<Part | null>(null),
  sound: signal(true),
};

const ASPECT_LABELS: readonly { value: VideoAspect; label: string; title: string }[] = [
  { value: '16:9', label: '16:9', title: 'Wide: screens and YouTube' },
  { value: '1:1', label: '1:1', title: 'Square' },
  { value: '9:16', label: '9:16', title: 'Upright: phones, Reels, Shorts, TikTok' },
];

const CAMERA_LABELS: readonly { value: VideoCamera; label: string; title: string }[] = [
  { value: 'follow', label: 'Follow', title: 'Goes along with the dancer' },
  { value: 'front', label: 'Front', title: 'Stands still, as from a seat in the audience' },
  { value: 'orbit', label: 'Orbit', title: 'Circles the dancer, once in eight bars' },
  { value: 'cuts', label: 'Beat cuts', title: 'Another shot every few bars, on the first beat' },
  { value: 'stage', label: 'As on stage', title: 'Looks from where you do now, and keeps to it' },
];

const SIZE_LABELS: Readonly<Record<number, string>> = {
  180: '180p, a quick look',
  360: '360p, for messages',
  720: '720p (HD)',
  1080: '1080p (Full HD)',
  1440: '1440p',
  2160: '2160p (4K)',
};

/** The dance as a video: how it is made, how large it gets, and the button that makes it. */
export function VideoForm() {
  const store = useStore();
  const { document, loop, song, duration, videoJob } = store.state;
  // Read here, so that the panel follows them.
  void [document.value.trim, loop.value, duration.value];
  const sound = choice.sound.value && song.value !== null;
  const { parts, part } = partsNow(choice.part.value, (range) => store.videoPlan({ range }) !== null);
  const options: VideoOptions = {
    aspect: choice.aspect.value,
    size: choice.size.value,
    fps: choice.fps.value,
    camera: choice.camera.value,
    background: choice.ground.value === 'stage' ? 'stage' : choice.colour.value,
    range: part,
    sound,
  };
  const support = useSupport(options);
  if (support instanceof Error || support?.any === false) return <NoVideo text={NO_VIDEO} />;
  const plan = store.videoPlan(options);
  const made = support ? chooseFormat(choice.format.value, support) : null;
  const words = support ? supportText(choice.format.value, made, support, sound) : '';
  const { width, height } = videoSize(choice.aspect.value, choice.size.value);
  const waits = sound && !song.value?.buffer;
  return (
    <>
      <p class="hint">
        {song.value ? `With the sound of “${song.value.reference.name}”. ` : ''}The video is made on this machine, frame
        by frame, and goes nowhere else.
      </p>
      <fieldset class="video-choices" disabled={videoJob.value !== null}>
        <legend class="visually-hidden">How the video is made</legend>
        <Picture />
        <Staging />
        <Extent parts={parts} part={part} support={support} hasSong={song.value !== null} />
      </fieldset>
      <p class="video-words hint" role="status">
        {words || (waits ? 'The song’s sound is not here yet: wait a moment, or leave it out.' : '')}
      </p>
      <div class="export-foot">
        {plan && (
          <p>
            <strong class="tabular">{clockTime(plan.frames / plan.fps)}</strong>
            <span class="hint tabular">
              {width} × {height}, {plan.frames} frames, about {sizeText(videoBytes(width, height, plan, sound))}
              {made && support ? `, ${contentsText(made, support)}` : ''}
            </span>
          </p>
        )}
        {videoJob.value ? (
          <VideoProgress />
        ) : (
          <button
            ref={takeFocus}
            type="button"
            class="primary motion-tone"
            disabled={!made || waits}
            onClick={() => made && void store.saveVideo({ ...options, format: made })}
          >
            <Icon name="follow" />
            {made ? `Save ${FORMAT_NAMES[made]}` : support ? 'Not possible here' : 'Looking…'}
          </button>
        )}
      </div>
    </>
  );
}

/** What this browser can make of the options; null while that is being found out. */
function useSupport(options: VideoOptions): VideoSupport | Error | null {
  const store = useStore();
  const found = useSignal<VideoSupport | Error | null>(null);
  const { aspect, size, fps, sound } = options;
  const buffer = store.state.song.value?.buffer;
  useEffect(() => {
    let current = true;
    store.videoSupport({ aspect, size, fps, sound }).then(
      (support) => current && (found.value = support),
      (error: Error) => current && (found.value = error),
    );
    return () => {
      current = false;
    };
  }, [store, found, aspect, size, fps, sound, buffer]);
  return found.value;
}

function Picture() {
  return (
    <div class="export-options">
      <Segments
        legend="Shape"
        name="video-aspect"
        value={choice.aspect.value}
        options={ASPECT_LABELS}
        onChange={(value) => (choice.aspect.value = value)}
      />
      <SizeField label="Size" size={choice.size} sizes={VIDEO_SIZES} text={(size) => SIZE_LABELS[size]} />
      <Segments
        legend="Frames per second"
        name="video-fps"
        value={choice.fps.value}
        options={[
          { value: 30, label: '30' },
          { value: 60, label: '60', title: 'Smoother; takes twice as long to make' },
        ]}
        onChange={(value) => (choice.fps.value = value)}
      />
    </div>
  );
}

function Staging() {
  const camera = CAMERA_LABELS.find(({ value }) => value === choice.camera.value)!;
  return (
    <div class="export-options">
      <div class="video-camera">
        <Segments
          legend="Camera"
          name="video-camera"
          value={choice.camera.value}
          options={CAMERA_LABELS}
          onChange={(value) => (choice.camera.value = value)}
        />
        <p class="hint">{camera.title}.</p>
      </div>
      <GroundField
        name="video-ground"
        ground={choice.ground}
        colour={choice.colour}
        options={[
          { value: 'stage', label: 'Stage' },
          { value: 'colour', label: 'Plain colour', title: 'One colour, to be cut out or to match a page' },
        ]}
      />
    </div>
  );
}

function Extent(props: { parts: readonly Part[]; part: Part; support: VideoSupport | null; hasSong: boolean }) {
  const { parts, part, support, hasSong } = props;
  const lacks = (format: VideoFormat) => support !== null && support.formats[format].video === null;
  return (
    <div class="export-options">
      {parts.length > 1 && (
        <Segments
          legend="Part"
          name="video-part"
          value={part}
          options={parts.map((value) => ({ value, label: PARTS[value] }))}
          onChange={(value) => (choice.part.value = value)}
        />
      )}
      <Segments
        legend="File"
        name="video-format"
        value={choice.format.value}
        options={(['mp4', 'webm'] as const).map((value) => ({
          value,
          label: FORMAT_NAMES[value],
          ...(lacks(value) ? { title: 'This browser has no encoder for it' } : {}),
        }))}
        onChange={(value) => (choice.format.value = value)}
      />
      {hasSong && (
        <label class="check video-sound">
          <input
            type="checkbox"
            checked={choice.sound.value}
            onChange={(event) => (choice.sound.value = event.currentTarget.checked)}
          />
          <span>With the song’s sound</span>
        </label>
      )}
    </div>
  );
}
