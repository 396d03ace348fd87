import type { DanceReport } from '../../app/report';
import { useStore } from '../store-context';
import { beatVerdict, footVerdict, freezeVerdict, jerkVerdict, keyVerdict, type Verdict } from './verdicts';

const ROWS: readonly { title: string; verdict(report: DanceReport): Verdict | null }[] = [
  { title: 'Key poses', verdict: keyVerdict },
  { title: 'On the beat', verdict: beatVerdict },
  { title: 'Smoothness', verdict: jerkVerdict },
  { title: 'Feet', verdict: footVerdict },
  { title: 'Longest standstill', verdict: freezeVerdict },
];

/** The reports of the two dances that are compared, beside each other. */
export function CompareTable() {
  const { compare, report, dance } = useStore().state;
  const held = compare.value;
  const now = report.value;
  if (!held?.report || !now || held.shown === 'a' || held.dance === dance.value) return null;
  const engine = (of: typeof held.dance | null) => (of?.inputs?.engine === 'curves' ? 'curves' : 'frames');
  const cell = (verdict: Verdict | null) => (verdict ? `${verdict.value} ${verdict.unit}` : '–');
  return (
    <table class="compare-table">
      <caption>Both dances</caption>
      <thead>
        <tr>
          <th scope="col">
            <span class="visually-hidden">Figure</span>
          </th>
          <th scope="col">A ({engine(held.dance)})</th>
          <th scope="col">B ({engine(dance.value)})</th>
        </tr>
      </thead>
      <tbody>
        {ROWS.map(({ title, verdict }) => (
          <tr key={title}>
            <th scope="row">{title}</th>
            <td>{cell(verdict(held.report!))}</td>
            <td>{cell(verdict(now))}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
