import { useSignal } from '@preact/signals';
import { useContext, useEffect } from 'preact/hooks';
import { STYLE_NAMES } from '../../app/actions/look';
import { DEFAULT_LOOK, FIGURE_COLOURS, FIGURE_STYLES, type FigureLook } from '../../core/figure-look';
import { jointIndex } from '../../core/skeleton';
import { OwnCharacter } from '../avatar/OwnCharacter';
import { Icon } from '../Icon';
import { useStore } from '../store-context';
import { ThumbnailsContext } from '../thumbs';

/** How the styles are shown: at ease, arms a little away from the body. */
const AT_EASE: readonly number[] = (() => {
  const pose = Array.from({ length: 72 }, () => 0);
  const turn = (joint: string, x: number, y: number, z: number) => pose.splice(jointIndex(joint) * 3, 3, x, y, z);
  turn('left_shoulder', 0, 0, -1.05);
  turn('right_shoulder', 0, 0, 1.05);
  turn('left_elbow', 0, -0.35, 0.1);
  turn('right_elbow', 0, 0.35, -0.1);
  turn('left_hip', 0, 0.05, 0.12);
  turn('right_hip', 0, -0.05, -0.12);
  return pose;
})();

/** What the figure wears: its style and its colours. Folded away until it is wanted. */
export function FigureSection() {
  const store = useStore();
  const open = useSignal(false);
  const look = store.state.document.value.look ?? DEFAULT_LOOK;
  const pictures = usePictures(open.value, look.colours);
  const colours = FIGURE_COLOURS.find(({ id }) => id === look.colours)!;
  return (
    <details class="fold figure-fold" onToggle={(event) => (open.value = event.currentTarget.open)}>
      <summary>
        <Icon name="chevronRight" size={16} />
        <span>Figure</span>
        <small>
          {store.state.avatar.value ? (
            store.state.avatar.value.name
          ) : (
            <>
              {STYLE_NAMES[look.style]}
              <Swatch {...colours} />
            </>
          )}
        </small>
      </summary>
      <div class="fold-body">
        <fieldset class="figure-styles">
          <legend class="visually-hidden">Style of the figure</legend>
          {FIGURE_STYLES.map((style, i) => (
            <label key={style} class="seed">
              <input
                type="radio"
                name="figure-style"
                checked={style === look.style}
                onChange={() => store.setLook({ style })}
              />
              {pictures[i] ? (
                <img class="pose-picture" src={pictures[i]} alt="" draggable={false} />
              ) : (
                <span class="pose-picture" />
              )}
              <span>{STYLE_NAMES[style]}</span>
            </label>
          ))}
        </fieldset>
        <fieldset class="figure-colours">
          <legend class="visually-hidden">Colours of the figure</legend>
          {FIGURE_COLOURS.map((each) => (
            <label key={each.id} class="figure-colour" title={each.name}>
              <input
                type="radio"
                name="figure-colours"
                aria-label={each.name}
                checked={each.id === look.colours}
                onChange={() => store.setLook({ colours: each.id })}
              />
              <Swatch {...each} />
            </label>
          ))}
        </fieldset>
        <OwnCharacter />
      </div>
    </details>
  );
}

/** Body above, its left and right below as they are seen from the front. */
function Swatch({ body, left, right }: { body: string; left: string; right: string }) {
  return (
    <span class="swatch" aria-hidden="true" style={{ background: body }}>
      <span style={{ background: right }} />
      <span style={{ background: left }} />
    </span>
  );
}

/** A picture of each style in these colours, made only once the section is open. */
function usePictures(wanted: boolean, colours: FigureLook['colours']): readonly (string | null)[] {
  const thumbnails = useContext(ThumbnailsContext);
  const made = useSignal<readonly (string | null)[]>([]);
  useEffect(() => {
    if (!wanted) return;
    let current = true;
    const before = made.peek();
    void Promise.all(FIGURE_STYLES.map((style) => thumbnails.dressed(AT_EASE, { style, colours }))).then((urls) => {
      const gone = current ? before : urls;
      if (current) made.value = urls;
      for (const url of gone) if (url) URL.revokeObjectURL(url);
    });
    return () => {
      current = false;
    };
  }, [wanted, colours, thumbnails, made]);
  return made.value;
}
