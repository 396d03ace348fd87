import type { DanceReport } from '../../app/report';
import { useStore } from '../store-context';

interface Line {
  name: string;
  value: string;
  sentence: string;
  tone: 'key' | 'music' | 'motion';
}

/**
 * Real dance, from calm to wild: the validation clips that move (export/evaluate.py measures them the same way). Jerk in m/s^3; speed of
 * toes on the floor in m/s, which is not zero because people turn on them.
 */
const REAL_DANCE = { jerk: [55, 305], footSkate: [0.16, 0.36] } as const;

const percent = (share: number) => `${Math.round(share * 100)}%`;

/** Numbers with units, and a sentence that says whether they are good. */
export function reportLines(report: DanceReport): Line[] {
  const lines: Line[] = [];
  const { consistencyError: error, jerk, footSkate } = report;
  if (!Number.isNaN(error)) {
    lines.push({
      name: 'Key poses',
      value: error < 5e-4 ? 'exact' : error.toFixed(3),
      sentence:
        error < 5e-4
          ? 'Every key pose is hit exactly.'
          : error < 0.1
            ? 'Close to your poses.'
            : 'Rather free with your poses.',
      tone: 'key',
    });
  }
  const hits = report.beatHitRate[1];
  if (!Number.isNaN(hits)) {
    lines.push({
      name: 'On the beat',
      value: percent(hits),
      sentence:
        hits > 0.5
          ? 'Moves land on most beats.'
          : hits > 0.25
            ? 'Moves land on many beats.'
            : 'Moves flow across the beats.',
      tone: 'music',
    });
  }
  if (!Number.isNaN(jerk)) {
    lines.push({
      name: 'Jerk',
      value: `${jerk.toFixed(0)} m/s³`,
      sentence:
        jerk < REAL_DANCE.jerk[0]
          ? 'Calmer than people dance.'
          : jerk < REAL_DANCE.jerk[1]
            ? 'As lively as people dance.'
            : 'Rougher than people dance.',
      tone: 'motion',
    });
  }
  if (!Number.isNaN(footSkate)) {
    lines.push({
      name: 'Foot sliding',
      value: `${(footSkate * 100).toFixed(0)} cm/s`,
      sentence:
        footSkate < REAL_DANCE.footSkate[0]
          ? 'Feet stand as firmly as those of calm dancers.'
          : footSkate < REAL_DANCE.footSkate[1]
            ? 'Feet turn and glide as dancers’ feet do.'
            : 'Feet slide more than dancers’ feet do.',
      tone: 'motion',
    });
  }
  return lines;
}

/** The report of the dance on stage. */
export function Report() {
  const { report } = useStore().state;
  const now = report.value;
  if (!now) return null;
  return (
    <section class="report" aria-label="Report of the dance">
      <h2>This dance</h2>
      <dl>
        {reportLines(now).map((line) => (
          <div key={line.name} class={`tone-${line.tone}`}>
            <dt>{line.name}</dt>
            <dd>
              <strong>{line.value}</strong>
              <span>{line.sentence}</span>
            </dd>
          </div>
        ))}
      </dl>
    </section>
  );
}
