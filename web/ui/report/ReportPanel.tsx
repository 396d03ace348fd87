import type { ComponentChildren } from 'preact';
import { REAL_DANCE } from '../../app/report-reference';
import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';
import { CompareTable } from './CompareTable';
import { Gauge } from './Gauge';
import { HitCurve } from './HitCurve';
import { KeyErrors } from './KeyErrors';
import { SavePicture } from './SavePicture';
import {
  beatVerdict,
  footVerdict,
  freezeVerdict,
  jerkVerdict,
  keyVerdict,
  smoothnessVerdict,
  type Verdict,
} from './verdicts';

/** How good the dance on stage is. */
export function ReportPanel() {
  const { report, stale, onStage, compare, generation } = useStore().state;
  const now = report.value;
  if (!now) {
    return (
      <p class="empty">
        {onStage.value && onStage.value.kind !== 'preview'
          ? 'Measuring the dance …'
          : 'Generate a dance, and this page tells how good it is: how close to your poses, how well on the beat, how smooth.'}
      </p>
    );
  }
  const keys = keyVerdict(now);
  const feet = footVerdict(now);
  const jerk = jerkVerdict(now);
  const smoothness = smoothnessVerdict(now);
  const freeze = freezeVerdict(now);
  return (
    <>
      {compare.value?.shown === 'a' ? (
        <p class="report-stale">
          <Icon name="info" size={16} />
          <span>This is A, the dance you held.</span>
        </p>
      ) : stale.value && generation.value.status === 'idle' ? (
        <p class="report-stale">
          <Icon name="info" size={16} />
          <span>Poses or settings changed since: this is the dance you see.</span>
        </p>
      ) : null}
      <CompareTable />
      <Card title="Your key poses" tone="key" verdict={keys}>
        {keys ? <KeyErrors errors={now.consistencyPerKey} /> : <p class="hint">This dance has no key poses.</p>}
      </Card>
      <Card title="On the beat" tone="music" verdict={beatVerdict(now)}>
        {now.beatHitRate.some(Number.isNaN) ? (
          <p class="hint">This song has no beats to hit.</p>
        ) : (
          <HitCurve rates={now.beatHitRate} />
        )}
        <CurvesSwitch />
      </Card>
      <Card title="Smoothness" tone="motion" verdict={jerk}>
        {jerk && (
          <Gauge
            value={now.jerk}
            real={REAL_DANCE.jerk}
            max={400}
            label={`Jerk ${jerk.value} metres per second cubed; real dance lies between ${REAL_DANCE.jerk.join(' and ')}.`}
          />
        )}
        <p class="report-aside">
          <strong>
            Longest standstill {freeze.value} {freeze.unit}
          </strong>{' '}
          {freeze.sentence}
        </p>
        {smoothness && (
          <p class="report-aside">
            <strong>
              S<sub>cv</sub> {smoothness.value}
            </strong>{' '}
            {smoothness.sentence}
          </p>
        )}
      </Card>
      {feet && (
        <Card title="Foot sliding" tone="motion" verdict={feet}>
          <Gauge
            value={now.footSkate * 100}
            real={[REAL_DANCE.footSkate[0] * 100, REAL_DANCE.footSkate[1] * 100]}
            max={60}
            label={`Feet slide ${feet.value} centimetres a second; real dance lies between 16 and 36.`}
          />
        </Card>
      )}
      <SavePicture />
      <p class="report-source">“Real dance” is measured on {REAL_DANCE.source}.</p>
    </>
  );
}

function Card(props: {
  title: string;
  tone: 'key' | 'music' | 'motion';
  verdict: Verdict | null;
  children: ComponentChildren;
}) {
  const { title, tone, verdict, children } = props;
  return (
    <section class={`card tone-${tone}`} aria-label={title}>
      <h2>{title}</h2>
      {verdict && (
        <p class="card-verdict">
          <strong>{verdict.value}</strong> <small>{unitText(verdict.unit)}</small>
          <span>{verdict.sentence}</span>
        </p>
      )}
      {children}
    </section>
  );
}

/** E_c with its index. */
function unitText(unit: string): ComponentChildren {
  if (!unit.startsWith('E_c')) return unit;
  return (
    <>
      E<sub>c</sub>
      {unit.slice(3)}
    </>
  );
}

/** Figure 9 on the timeline: shown or hidden. */
function CurvesSwitch() {
  const store = useStore();
  const shown = store.state.curvesShown.value;
  return (
    <button
      type="button"
      class="secondary full switch"
      aria-pressed={shown}
      title={tip('curves')}
      onClick={() => store.toggleCurves()}
    >
      <Icon name="activity" />
      {shown ? 'Hide the moves on the timeline' : 'See the moves on the timeline'}
    </button>
  );
}
