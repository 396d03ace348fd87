import { rangeName } from '../../app/range-name';
import { useStore } from '../store-context';
import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { PosePicture } from '../thumbs';
import { TakeStepper } from '../report/TakeStepper';
import { TradeOffPlot } from '../report/TradeOffPlot';
import { EngineSwitch } from '../curves/EngineSwitch';
import { FigureSection } from '../figure/FigureSection';
import { Slider } from './Slider';

const strengthText = (value: number) =>
  value >= 0.995
    ? 'Every key pose is hit exactly.'
    : value < 0.005
      ? 'The network alone: poses are hints.'
      : 'Near your poses, a little freer.';
const variationText = (value: number) =>
  value < 0.05 ? 'As plain as it gets.' : value < 0.5 ? 'Some life between your poses.' : 'The dancer improvises.';

/** The dials: key strength moves the dance at hand, the others the next one. */
export function DancePanel() {
  const store = useStore();
  const { document, loop, generation, dance, grid, compare } = store.state;
  const { dials } = document.value;
  const range = loop.value;
  const chosen = document.value.ranges.filter((each) => each.chosen !== null).length;
  return (
    <>
      <SeedClips />
      <section class="block" aria-label="Settings">
        <EngineSwitch />
        {document.value.engine === 'curves' ? (
          <p class="hint">Curves run through every key pose exactly, so there is no key strength to set.</p>
        ) : (
          <>
            <Slider
              label="Key strength"
              value={store.state.strengthDraft.value ?? dials.keyStrength}
              text={strengthText}
              tone="key"
              onPreview={(value) => store.previewStrength(value)}
              onCommit={(value) => store.commitStrength(value)}
            />
            <TradeOffPlot />
          </>
        )}
        <Slider
          label="Variation"
          value={dials.variation}
          text={variationText}
          tone="motion"
          onCommit={(value) => store.setDial('variation', value)}
        />
        <TakeStepper />
        {range && dance.value && dance.value.kind !== 'preview' && (
          <button
            type="button"
            class="secondary full"
            disabled={generation.value.status !== 'idle'}
            title={tip('regenerate', 'Another take of the selected range only')}
            onClick={() => void store.regenerateRange(range)}
          >
            <Icon name="sparkles" />
            Regenerate {rangeName(grid.value, range)}
          </button>
        )}
        {chosen > 0 && (
          <p class="ranges-note">
            <span>
              {chosen === 1 ? 'One range has' : `${chosen} ranges have`} a take of {chosen === 1 ? 'its' : 'their'} own,
              danced again with the whole.
            </span>
            <button type="button" class="quiet" onClick={() => void store.deleteRanges()}>
              Delete {chosen === 1 ? 'it' : 'them'}
            </button>
          </p>
        )}
        {dance.value && dance.value.kind !== 'preview' && !compare.value && (
          <button type="button" class="quiet compare-start" title={tip('compare')} onClick={() => store.compare()}>
            Hold this dance to compare (A/B)
          </button>
        )}
      </section>
      <FigureSection />
      <Engine />
    </>
  );
}

function SeedClips() {
  const store = useStore();
  const { seeds, seedClip } = store.state;
  return (
    <fieldset class="seeds">
      <legend>Starts as</legend>
      <div class="seed-grid">
        {seeds.value.map((clip) => (
          <label key={clip.id} class="seed" title={clip.description}>
            <input
              type="radio"
              name="seed-clip"
              checked={seedClip.value?.id === clip.id}
              onChange={() => store.setDial('seedClip', clip.id)}
            />
            <PosePicture rotations={clip.poses[0]} />
            <span>{clip.name}</span>
          </label>
        ))}
      </div>
      {seedClip.value && <p class="hint">{seedClip.value.description}</p>}
    </fieldset>
  );
}

/** Where the model runs and why. */
function Engine() {
  const { model } = useStore().state;
  const info = model.value;
  const where = info
    ? info.backend === 'webgpu'
      ? 'the graphics card (WebGPU)'
      : `the processor (WASM, ${info.threads} thread${info.threads === 1 ? '' : 's'})`
    : null;
  return (
    <p class="engine" title={info?.reason}>
      <Icon name="info" size={16} />
      <span>
        {where
          ? `Runs on ${where}. ${info!.reason}`
          : 'The model loads with your first dance, and stays on this device.'}
      </span>
    </p>
  );
}
