import { useSignal } from '@preact/signals';
import { useEffect, useLayoutEffect, useRef } from 'preact/hooks';
import { TOUR_STEPS } from '../../app/actions/tour';
import { Icon } from '../Icon';
import { keyText } from '../shortcuts';
import { useStore } from '../store-context';
import { placeCard, type Place } from './place';

/** The page shows itself first, milliseconds. */
const OFFER_DELAY = 1200;

interface Step {
  title: string;
  text: string;
  /** What it is about: the first of these that can be seen. */
  anchors: readonly string[];
  /** The card goes above this block, where there is room, and not beside the anchor. */
  above?: string;
}

const STEPS: readonly Step[] = [
  {
    title: 'Start with your song',
    text: 'Drop a file anywhere, or choose one. Its beats are found at once.',
    anchors: ['.drop-target', '.new-song'],
    above: '.welcome',
  },
  {
    title: 'Place a few poses',
    text: 'Drag poses onto the beats of the timeline, or click one to put it at the playhead. Two are enough to begin.',
    anchors: ['.pose-grid', '#tab-poses'],
  },
  {
    title: 'Make the dance',
    text: 'The dancer finds a way through your poses, on the beat.',
    anchors: ['.generate'],
  },
  {
    title: 'Play and change',
    text: 'Watch it, move a pose, try another take. Whatever you do can be undone.',
    anchors: ['.play'],
  },
];

/** Controls on the stage that a card never covers. */
const KEEP_FREE = '.stage-tools, .sound-chip, .work-chip, .drop-target, .welcome h1';

/** The walk-through: one small card on the stage, beside what it speaks of. Only its buttons take clicks. */
export function Tour() {
  const store = useStore();
  const { state } = store;

  useEffect(() => {
    let timer: ReturnType<typeof setTimeout> | undefined;
    void store.whenReady().then(() => {
      timer = setTimeout(() => store.offerTour(), OFFER_DELAY);
    });
    return () => clearTimeout(timer);
  }, [store]);

  const step = state.tour.value;
  // The editor and the help need the room; the step waits.
  if (step === null || state.draft.value || state.help.value) return null;
  return <Card key={step} index={step} />;
}

function Card({ index }: { index: number }) {
  const store = useStore();
  const card = useRef<HTMLElement>(null);
  const place = useSignal<(Place & { anchor: DOMRect }) | null>(null);
  const { title, text, anchors, above } = STEPS[index];
  // What moves the anchors about: another panel, the welcome gone, a chip come.
  const { panel, song, songJob, sheetOpen, generation, curvesShown } = store.state;
  const layout = [panel, song, songJob, sheetOpen, curvesShown].map((each) => each.value);

  const update = () => {
    const stage = document.querySelector('.stage')?.getBoundingClientRect();
    const anchor = anchors.map(seen).find((each) => each !== null);
    const own = card.current?.getBoundingClientRect();
    if (!stage || !anchor || !own) {
      place.value = null;
      return;
    }
    const avoid = [...document.querySelectorAll(KEEP_FREE)].map((element) => element.getBoundingClientRect());
    const block = above ? seen(above) : null;
    const next = { ...placeCard(own, block ?? anchor, stage, avoid, block !== null), anchor };
    if (JSON.stringify(next) !== JSON.stringify(place.peek())) place.value = next;
  };
  useLayoutEffect(update, [index, generation.value.status, ...layout]);
  useEffect(() => {
    const observer = new ResizeObserver(update);
    for (const element of document.querySelectorAll(['.stage, .inspector, .transport, .timeline', ...anchors].join()))
      observer.observe(element);
    window.addEventListener('resize', update);
    return () => {
      observer.disconnect();
      window.removeEventListener('resize', update);
    };
  }, [index, generation.value.status, ...layout]);
  useEffect(() => store.announce(`Step ${index + 1} of ${TOUR_STEPS}: ${title}. ${text}`), [index]);

  const at = place.value;
  const last = index === TOUR_STEPS - 1;
  return (
    <>
      {at && (
        <div
          class="tour-ring"
          style={{
            left: `${at.anchor.left}px`,
            top: `${at.anchor.top}px`,
            width: `${at.anchor.width}px`,
            height: `${at.anchor.height}px`,
          }}
        />
      )}
      <section
        ref={card}
        class={`tour ${at ? `points-${at.side}` : 'nowhere'}`}
        aria-label="First steps"
        style={at ? { left: `${at.left}px`, top: `${at.top}px`, '--along': `${at.along}px` } : {}}
      >
        <p class="tour-head">
          <span class="tour-count">
            {index + 1} of {TOUR_STEPS}
          </span>
          <strong>{title}</strong>
        </p>
        <p>{text}</p>
        <p class="tour-foot">
          <button
            type="button"
            class="quiet"
            aria-label="Skip the tour"
            title={`Skip the tour (${keyText('Escape')}). H brings it back.`}
            onClick={() => store.endTour()}
          >
            <span>Skip the tour</span>
            <Icon name="close" />
          </button>
          <button
            type="button"
            class="quiet"
            aria-label={last ? 'Finish the tour' : 'Next step'}
            onClick={() => store.nextTourStep()}
          >
            <span>{last ? 'Done' : 'Next step'}</span>
            <Icon name={last ? 'check' : 'chevronRight'} />
          </button>
        </p>
      </section>
    </>
  );
}

/** The part of an element that can be seen, or null when there is none. */
function seen(selector: string): DOMRect | null {
  const element = document.querySelector(selector);
  const box = element?.getBoundingClientRect();
  if (!element || !box || box.width === 0 || box.height === 0) return null;
  const parent = element.closest('.panel')?.getBoundingClientRect();
  const top = Math.max(box.top, parent?.top ?? 0, 0);
  const bottom = Math.min(box.bottom, parent?.bottom ?? innerHeight, innerHeight);
  return bottom - top < 8 ? null : new DOMRect(box.left, top, box.width, bottom - top);
}
