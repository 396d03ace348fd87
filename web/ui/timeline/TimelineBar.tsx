import { BeatTools } from './BeatTools';
import { SuggestTools } from '../suggest/SuggestTools';
import { KeyTools } from './KeyTools';
import { RangeTools } from './RangeTools';
import { SnapTools } from './SnapTools';

/** One row of tools over the lanes: snapping, beats, suggestions, the selected range, the selected key poses. */
export function TimelineBar() {
  return (
    <div class="timeline-bar" role="toolbar" aria-label="Timeline tools">
      <SnapTools />
      <BeatTools />
      <SuggestTools />
      <RangeTools />
      <KeyTools />
    </div>
  );
}
