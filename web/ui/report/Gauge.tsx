/** A value on a scale, with the stretch where real dance lies. */
export function Gauge(props: { value: number; real: readonly [number, number]; max: number; label: string }) {
  const { value, real, max, label } = props;
  const share = (at: number) => `${Math.min(100, Math.max(0, (at / max) * 100))}%`;
  return (
    <div class="gauge" role="img" aria-label={label}>
      <div class="gauge-track">
        <div
          class="gauge-real"
          style={{ left: share(real[0]), width: `calc(${share(real[1])} - ${share(real[0])})` }}
        />
        <div class="gauge-mark" style={{ left: share(value) }} />
      </div>
      <div class="gauge-scale" aria-hidden="true">
        <span>0</span>
        <span class="gauge-caption" style={{ left: share((real[0] + real[1]) / 2) }}>
          real dance
        </span>
        <span>{max}</span>
      </div>
    </div>
  );
}
