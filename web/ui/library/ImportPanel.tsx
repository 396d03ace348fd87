import { useComputed, useSignal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import type { PoseImport } from '../../app/pose-state';
import { poseOfFrame, suggestFrames } from '../../core/formats/pose-sequence';
import { Icon } from '../Icon';
import { useStore } from '../store-context';
import { DrawnPose, PosePicture } from '../thumbs';
import { ImportMotion } from './ImportMotion';

/** Frames in the strip of suggestions. */
const SUGGESTED = 6;
/** The figure itself is drawn when the scrubber has rested this long, milliseconds; until then a sketch. */
const REST = 140;

const seconds = (frame: number, fps: number) => (fps > 0 ? frame / fps : 0).toFixed(2);

/** Which frame of an animation file becomes a pose. */
export function ImportPanel() {
  const store = useStore();
  const { poseImport } = store.state;
  const heading = useRef<HTMLHeadingElement>(null);
  const file = poseImport.value?.file;
  useEffect(() => heading.current?.focus(), [file]);
  const suggestions = useSuggestions();
  const open = poseImport.value;
  if (!open) return null;
  const clip = open.clips[open.clip];
  const many = clip.frames > 1;
  const last = clip.frames - 1;
  const where = `${seconds(open.frame, clip.fps)} s, frame ${open.frame + 1} of ${clip.frames}`;
  return (
    <section
      class="pose-import"
      aria-labelledby="pose-import-title"
      onKeyDown={(event) => {
        if (event.key !== 'Escape') return;
        event.preventDefault();
        store.closePoseImport();
      }}
    >
      <header class="pose-import-head">
        <div>
          <h3 id="pose-import-title" ref={heading} tabIndex={-1}>
            {many ? 'Choose a frame' : 'A pose from a file'}
          </h3>
          <small>
            {open.file} · {open.kind}
          </small>
        </div>
        <button type="button" class="tool" aria-label="Close the file" onClick={() => store.closePoseImport()}>
          <Icon name="close" />
        </button>
      </header>
      {open.clips.length > 1 && (
        <label class="field">
          <span>Animation</span>
          <select value={String(open.clip)} onChange={(event) => store.chooseClip(Number(event.currentTarget.value))}>
            {open.clips.map((each, i) => (
              <option key={i} value={String(i)}>
                {each.name || `Animation ${i + 1}`} ({seconds(each.frames - 1, each.fps)} s)
              </option>
            ))}
          </select>
        </label>
      )}
      <FramePicture open={open} />
      {many && (
        <div class="scrubber">
          <button
            type="button"
            class="tool"
            aria-label="Previous frame"
            disabled={open.frame === 0}
            onClick={() => store.chooseFrame(open.frame - 1)}
          >
            <Icon name="chevronLeft" />
          </button>
          <input
            type="range"
            class="tone-key"
            aria-label="Frame"
            aria-valuetext={where}
            min={0}
            max={last}
            step={1}
            value={open.frame}
            style={{ '--tone': 'var(--key)', '--fill': `${(open.frame / last) * 100}%` }}
            onInput={(event) => store.chooseFrame(Number(event.currentTarget.value))}
          />
          <button
            type="button"
            class="tool"
            aria-label="Next frame"
            disabled={open.frame === last}
            onClick={() => store.chooseFrame(open.frame + 1)}
          >
            <Icon name="chevronRight" />
          </button>
          <small class="tabular">{where}</small>
        </div>
      )}
      {many && (
        <div>
          <h4>{clip.marks ? 'Its key poses' : 'Held moments'}</h4>
          <ul class="moments">
            {suggestions.value.map(({ frame, rotations }) => (
              <li key={frame}>
                <button
                  type="button"
                  aria-pressed={frame === open.frame}
                  aria-label={`Frame ${frame + 1}, at ${seconds(frame, clip.fps)} seconds`}
                  onClick={() => store.chooseFrame(frame)}
                >
                  <PosePicture rotations={rotations} />
                  <small class="tabular">{seconds(frame, clip.fps)} s</small>
                </button>
              </li>
            ))}
          </ul>
        </div>
      )}
      {many && <ImportMotion />}
      <div class="pose-import-actions">
        <button type="button" class="primary key-tone" onClick={() => store.placeFrame()}>
          <Icon name="plus" />
          Add to timeline
        </button>
        <button type="button" class="secondary" onClick={() => store.editFrame()}>
          Edit
        </button>
        <button type="button" class="secondary" onClick={() => store.saveFrame()} title="Save to My poses">
          Save
        </button>
      </div>
    </section>
  );
}

/** Worked out once per animation; the poses keep their arrays, and with them their pictures. */
function useSuggestions() {
  const { poseImport } = useStore().state;
  const clip = useComputed(() => {
    const open = poseImport.value;
    return open ? open.clips[open.clip] : null;
  });
  return useComputed(() => {
    const now = clip.value;
    if (!now || now.frames < 2) return [];
    return suggestFrames(now, SUGGESTED).map((frame) => ({ frame, rotations: poseOfFrame(now, frame) }));
  });
}

/** The chosen frame, large: a sketch that follows the scrubber at once, the figure when it rests. */
function FramePicture({ open }: { open: PoseImport }) {
  const rested = useSignal<{ clip: number; frame: number; rotations: number[] } | null>(null);
  const { clip, frame } = open;
  const sequence = open.clips[clip];
  useEffect(() => {
    const timer = setTimeout(() => (rested.value = { clip, frame, rotations: poseOfFrame(sequence, frame) }), REST);
    return () => clearTimeout(timer);
  }, [clip, frame, sequence, rested]);
  const still = rested.value;
  return (
    <div class="frame-picture">
      {still && still.clip === clip && still.frame === frame ? (
        <PosePicture rotations={still.rotations} />
      ) : (
        <DrawnPose rotations={poseOfFrame(sequence, frame)} sketch />
      )}
    </div>
  );
}
