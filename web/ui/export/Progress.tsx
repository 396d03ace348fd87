import { Icon } from '../Icon';

/** What a button shows while a file is made that pressing it stops. */
export function Progress({ word, done }: { word: string; /** 0..1. */ done: number }) {
  const percent = Math.round(done * 100);
  return (
    <>
      <span class="progress-fill" style={{ width: `${percent}%` }} />
      <Icon name="close" />
      <span class="progress-text">
        {word} <span class="tabular">{percent}%</span>
      </span>
    </>
  );
}
