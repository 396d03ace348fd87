import { signal } from '@preact/signals';
import type { MotionFileOptions } from '../../app/actions/export';
import { estimateBytes, extensionOf, FRAME_RATES, type MotionFormat } from '../../app/motion-formats';
import { clockTime } from '../../app/snapping';
import type { CurveDance } from '../../core/curves';
import spec from '../../core/spec.json';
import { Dialog } from '../Dialog';
import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';
import { takeFocus } from '../video/VideoProgress';
import { curveBytes, FORMAT_CARDS, sizeText, type CardFormat, type FormatCard } from './formats';
import { NoDance } from './NoDance';
import { PARTS, partsNow, type Part } from './parts';
import { Progress } from './Progress';
import { Segments } from './Segments';

/** What was chosen last; it stays while the page is open. */
const choice = {
  format: signal<CardFormat>('glb'),
  curves: signal<'glb' | 'json'>('glb'),
  fps: signal<number>(spec.fps),
  units: signal<'m' | 'cm'>('cm'),
  figure: signal(true),
  part: signal<Part | null>(null),
};

/** Opens the panel. */
export function ExportButton() {
  const store = useStore();
  return (
    <button
      type="button"
      class="tool wide"
      aria-label="Export the dance"
      aria-haspopup="dialog"
      title={tip('export')}
      onClick={() => store.toggleExport(true)}
    >
      <Icon name="fileOut" />
    </button>
  );
}

/** The dance as a file for other programs. */
export function ExportPanel() {
  const store = useStore();
  return (
    <Dialog
      open={store.state.exportOpen.value}
      onClose={() => store.toggleExport(false)}
      title="Export the dance"
      titleId="export-title"
      kind="export-panel"
      bodyClass="export-body"
      keepsKeys
    >
      {() => <Contents />}
    </Dialog>
  );
}

function Contents() {
  const store = useStore();
  const { onStage, document, loop, song, avatar } = store.state;
  const dance = onStage.value;
  // Read here, so that the panel follows them.
  void [document.value.trim, loop.value];
  if (!dance || dance.kind === 'preview') return <NoDance />;
  const own = avatar.value?.source.bytes.length;
  const cards = FORMAT_CARDS.filter(({ format }) => format !== 'avatar' || own !== undefined);
  const card = cards.find(({ format }) => format === choice.format.value) ?? cards[0];
  const { parts, part } = partsNow(choice.part.value, (each) => store.exportFrames(each) !== null);
  const frames = store.exportFrames(part) ?? 0;
  const last = Math.max(0, frames - 1) / dance.motion.fps;
  const fps = choice.fps.value;
  const count = Math.floor(last * fps + 1e-6) + 1;
  const ownBytes = card.format === 'avatar' ? own! : 0;
  const options: MotionFileOptions = { fps, units: choice.units.value, figure: choice.figure.value, range: part };
  const name = song.value?.reference.name ?? document.value.song?.name;
  return (
    <>
      <p class="hint">{name ? `To “${name}”. ` : ''}The file is made on this machine and goes nowhere else.</p>
      <fieldset class="export-cards">
        <legend class="visually-hidden">Format</legend>
        {cards.map((each) => (
          <FormatChoice key={each.format} card={each} chosen={each === card} />
        ))}
      </fieldset>
      <button
        type="button"
        class="secondary full"
        onClick={() => {
          store.toggleExport(false);
          store.toggleVideo(true);
        }}
      >
        <Icon name="follow" />
        Save as a video with the song instead
      </button>
      <Options card={card} parts={parts} part={part} />
      {card.format === 'curves' ? (
        <CurvesFoot curves={dance.curves} frames={dance.motion.frames} />
      ) : (
        <div class="export-foot">
          <p>
            <strong class="tabular">{clockTime(frames / dance.motion.fps)}</strong>
            <span class="hint tabular">
              {count} frames, about {sizeText(estimateBytes(card.format, count, choice.figure.value) + ownBytes)}
            </span>
          </p>
          <SaveButton format={card.format} options={options} />
        </div>
      )}
    </>
  );
}

/** Saves the curves; where the dance is one of frames, says how to get some. */
function CurvesFoot({ curves, frames }: { curves: CurveDance | undefined; frames: number }) {
  const store = useStore();
  const as = choice.curves.value;
  const figure = as === 'glb' && choice.figure.value;
  if (!curves)
    return (
      <div class="export-foot">
        <p class="hint">This dance was drawn frame by frame. Danced as curves it keeps your key poses.</p>
        <button
          type="button"
          class="secondary"
          onClick={() => {
            store.toggleExport(false);
            store.setEngine('curves');
            void store.generateForPage();
          }}
        >
          <Icon name="sparkles" />
          Dance it as curves
        </button>
      </div>
    );
  return (
    <div class="export-foot">
      <p>
        <strong class="tabular">{clockTime(curves.duration)}</strong>
        <span class="hint tabular">
          {curves.times.length} keys, about {sizeText(curveBytes(as, curves.times.length, figure ? frames : 0))}
        </span>
      </p>
      <button type="button" class="primary motion-tone" onClick={() => void store.saveCurves(as, { figure })}>
        <Icon name="download" />
        Save .{as}
      </button>
    </div>
  );
}

function FormatChoice({ card, chosen }: { card: FormatCard; chosen: boolean }) {
  return (
    <label class="export-card">
      <input
        type="radio"
        class="visually-hidden"
        name="export-format"
        checked={chosen}
        autofocus={chosen}
        aria-describedby={`export-${card.format}`}
        onChange={() => (choice.format.value = card.format)}
      />
      <span class="export-mark" aria-hidden="true">
        <Icon name="check" size={16} />
      </span>
      <span>
        <strong>{card.name}</strong>
        <small id={`export-${card.format}`}>{card.text}</small>
      </span>
    </label>
  );
}

function Options({ card, parts, part }: { card: FormatCard; parts: readonly Part[]; part: Part }) {
  const isCurves = card.format === 'curves';
  return (
    <div class="export-options">
      {card.choices.includes('curves') && (
        <Segments
          legend="File"
          name="export-curves"
          value={choice.curves.value}
          options={[
            { value: 'glb', label: 'GLB', title: 'A cubic spline for every joint' },
            { value: 'json', label: 'JSON', title: 'Knots, tension, continuity and bias, for programs of your own' },
          ]}
          onChange={(value) => (choice.curves.value = value)}
        />
      )}
      {card.choices.includes('figure') && (!isCurves || choice.curves.value === 'glb') && (
        <Segments
          legend="Content"
          name="export-figure"
          value={choice.figure.value}
          options={[
            { value: true, label: 'Figure', title: 'Our figure, skinned and dancing' },
            { value: false, label: 'Skeleton only', title: 'The 24 joints and their motion' },
          ]}
          onChange={(value) => (choice.figure.value = value)}
        />
      )}
      {card.choices.includes('units') && (
        <Segments
          legend="Units"
          name="export-units"
          value={choice.units.value}
          options={[
            { value: 'cm', label: 'Centimetres' },
            { value: 'm', label: 'Metres' },
          ]}
          onChange={(value) => (choice.units.value = value)}
        />
      )}
      {!isCurves && (
        <Segments
          legend="Frames per second"
          name="export-fps"
          value={choice.fps.value}
          options={FRAME_RATES.map((value) => ({
            value: value as number,
            label: String(value),
            ...(value === spec.fps ? { title: 'As the dance is made' } : {}),
          }))}
          onChange={(value) => (choice.fps.value = value)}
        />
      )}
      {!isCurves && parts.length > 1 && (
        <Segments
          legend="Part"
          name="export-part"
          value={part}
          options={parts.map((value) => ({ value, label: PARTS[value] }))}
          onChange={(value) => (choice.part.value = value)}
        />
      )}
      {card.hint && <p class="hint">{card.hint}</p>}
    </div>
  );
}

function SaveButton({ format, options }: { format: MotionFormat; options: MotionFileOptions }) {
  const store = useStore();
  const job = store.state.exportJob.value;
  return (
    <>
      {job ? (
        <button
          ref={takeFocus}
          type="button"
          class="secondary progress"
          title="Stop writing"
          onClick={() => store.cancelExport()}
        >
          <Progress word="Writing" done={job.fraction} />
        </button>
      ) : (
        <button
          ref={takeFocus}
          type="button"
          class="primary motion-tone"
          onClick={() => void store.saveMotion(format, options)}
        >
          <Icon name="download" />
          Save .{extensionOf(format)}
        </button>
      )}
      <div class="visually-hidden" role="status">
        {job ? 'Writing the file.' : ''}
      </div>
    </>
  );
}
