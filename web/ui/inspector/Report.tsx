import type { DanceReport } from '../../app/report';
import { useStore } from '../store-context';

interface Line {
  name: string;
  value: string;
  sentence: string;
  tone: 'key' | 'music' | 'motion';
}

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
        jerk < 40
          ? 'Very smooth, maybe too calm.'
          : jerk < 400
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
        footSkate < 0.1 ? 'Planted feet stay planted.' : footSkate < 0.25 ? 'Feet glide a little.' : 'Feet slide.',
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
