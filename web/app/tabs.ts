/** Which of several tabs writes the project: Web Locks decide, a BroadcastChannel hands over. */
import { signal, type ReadonlySignal } from '@preact/signals';

/** The tabs of one browser that show the same project. */
export interface Tabs {
  /** True in the one tab that saves. */
  readonly writes: ReadonlySignal<boolean>;
  /** Resolves when it is known whether this tab writes. */
  start(): Promise<void>;
  /** Makes this tab the one that writes; the other saves what it has first. */
  takeOver(): Promise<void>;
  /** Called before this tab hands over: the last chance to save. */
  onLeave(save: () => Promise<void>): void;
  /** Called after this tab became the one that writes, whether asked for or because the other was closed. */
  onGain(gained: () => void): void;
}

/** A tab that reloads still holds its lock for a moment, milliseconds. */
const GRACE = 300;
/** A tab that does not answer (asleep, stopped in a debugger) is not waited for longer, milliseconds. */
const ANSWER_TIMEOUT = 1500;

type Message = { type: 'hand over' } | { type: 'saved' };

/** @param name - Of the project's place in this browser; tabs with the same name share it. */
export function createTabs(name = 'posebeat'): Tabs {
  const writes = signal(true);
  const locks = (globalThis.navigator as Navigator | undefined)?.locks as LockManager | undefined;
  const channel = locks && 'BroadcastChannel' in globalThis ? new BroadcastChannel(name) : null;
  let save = (): Promise<void> => Promise.resolve();
  let gained = () => {};
  let queue: AbortController | null = null;
  let answered = () => {};
  /** Set while this tab waits for another to take the lock away. */
  let leaving: ReturnType<typeof setTimeout> | undefined;

  /** Holds the lock until the page ends or another tab steals it. Resolves when it is held. */
  function hold(options: LockOptions): Promise<void> {
    return new Promise((granted, refused) => {
      let held = false;
      locks!
        .request(name, options, () => {
          held = true;
          granted();
          return new Promise<never>(() => undefined);
        })
        .catch((error: unknown) => {
          if (held) lost();
          else refused(error instanceof Error ? error : new Error(String(error)));
        });
    });
  }

  /** Waits in line: when the other tab is closed, this one goes on by itself. */
  function wait(onGrant: () => void): Promise<void> {
    queue = new AbortController();
    return hold({ signal: queue.signal }).then(
      () => {
        queue = null;
        writes.value = true;
        onGrant();
      },
      () => undefined, // this tab takes over instead
    );
  }

  function lost(): void {
    clearTimeout(leaving);
    writes.value = false;
    void wait(() => gained());
  }

  channel?.addEventListener('message', ({ data }: MessageEvent<Message>) => {
    if (data.type === 'saved') answered();
    else if (writes.value) void handOver();
  });

  async function handOver(): Promise<void> {
    await save().catch(() => undefined);
    writes.value = false;
    channel?.postMessage({ type: 'saved' } satisfies Message);
    // Should the other tab be gone by now, this one goes on.
    clearTimeout(leaving);
    leaving = setTimeout(() => (writes.value = true), 2 * ANSWER_TIMEOUT);
  }

  return {
    writes,
    async start() {
      if (!locks) return;
      let known = false;
      const granted = wait(() => known && gained());
      await Promise.race([granted, new Promise((resolve) => setTimeout(resolve, GRACE))]);
      writes.value = queue === null;
      known = true;
    },
    async takeOver() {
      if (!locks || writes.value) return;
      await new Promise<void>((resolve) => {
        answered = resolve;
        channel?.postMessage({ type: 'hand over' } satisfies Message);
        setTimeout(resolve, channel ? ANSWER_TIMEOUT : 0);
      });
      queue?.abort();
      queue = null;
      await hold({ steal: true });
      writes.value = true;
      gained();
    },
    onLeave: (listener) => (save = listener),
    onGain: (listener) => (gained = listener),
  };
}
