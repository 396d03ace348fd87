import spec from '../../core/spec.json';
import { REAL_DANCE } from '../../app/report-reference';

const BOX = { width: 288, height: 148, left: 34, right: 10, top: 10, bottom: 34 };
const x = (delta: number) => BOX.left + ((delta - 1) / 4) * (BOX.width - BOX.left - BOX.right);
const y = (share: number) => BOX.top + (1 - share) * (BOX.height - BOX.top - BOX.bottom);
const path = (rates: readonly number[]) => rates.map((rate, i) => `${i ? 'L' : 'M'}${x(i + 1)} ${y(rate)}`).join('');
const percent = (share: number) => `${Math.round(share * 100)}%`;

/** Beat hit rate over the tolerance (paper A, figure 4), against real dance. */
export function HitCurve({ rates }: { rates: readonly number[] }) {
  return (
    <figure class="plot">
      <svg viewBox={`0 0 ${BOX.width} ${BOX.height}`} aria-hidden="true">
        {[0, 0.5, 1].map((share) => (
          <g key={share}>
            <line class="plot-grid" x1={BOX.left} x2={BOX.width - BOX.right} y1={y(share)} y2={y(share)} />
            <text class="plot-text" x={BOX.left - 6} y={y(share) + 4} text-anchor="end">
              {percent(share)}
            </text>
          </g>
        ))}
        {rates.map((_, i) => (
          <text key={i} class="plot-text" x={x(i + 1)} y={BOX.height - 20} text-anchor="middle">
            {Math.round(((i + 1) / spec.fps) * 1000)}
          </text>
        ))}
        <text class="plot-text" x={(BOX.left + BOX.width - BOX.right) / 2} y={BOX.height - 4} text-anchor="middle">
          a move within so many milliseconds of the beat
        </text>
        <path class="plot-line real" d={path(REAL_DANCE.beatHitRate)} />
        <path class="plot-line own" d={path(rates)} />
        {rates.map((rate, i) => (
          <circle key={i} class="plot-dot" cx={x(i + 1)} cy={y(rate)} r={3.5} />
        ))}
      </svg>
      <p class="plot-legend" aria-hidden="true">
        <span class="legend-key own">this dance</span>
        <span class="legend-key real">real dance</span>
      </p>
      <table class="visually-hidden">
        <caption>Share of beats with a move near them</caption>
        <thead>
          <tr>
            <th scope="col">Within</th>
            <th scope="col">This dance</th>
            <th scope="col">Real dance</th>
          </tr>
        </thead>
        <tbody>
          {rates.map((rate, i) => (
            <tr key={i}>
              <th scope="row">{i + 1} frames</th>
              <td>{percent(rate)}</td>
              <td>{percent(REAL_DANCE.beatHitRate[i])}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </figure>
  );
}
