/** One step that can be taken back. */
interface Step<T> {
  state: T;
  label: string;
}

/**
 * Undo and redo over immutable states.
 *
 * A drag is one step: `capture()` marks where it began, `preview()` shows what it would do, and only `commit()` makes a step of it;
 * `discard()` goes back as if nothing had happened, redo included. What is not part of the state (selection, playback) never comes
 * here and so never wipes redo.
 */
export class History<T> {
  #past: Step<T>[] = [];
  #future: Step<T>[] = [];
  #present: T;
  #captured: { state: T } | null = null;
  readonly #limit: number;

  /**
   * @param initial - The first state.
   * @param limit - Steps kept for undo, at least 1.
   */
  constructor(initial: T, limit = 500) {
    this.#present = initial;
    this.#limit = Math.max(1, limit);
  }

  /** The state to show: inside a capture, the previewed one. */
  get present(): T {
    return this.#present;
  }

  /** True between `capture()` and `commit()` or `discard()`. */
  get capturing(): boolean {
    return this.#captured !== null;
  }

  /** What undo would take back, or null when there is nothing. */
  get undoLabel(): string | null {
    return this.#past.at(-1)?.label ?? null;
  }

  /** What redo would bring again, or null when there is nothing. */
  get redoLabel(): string | null {
    return this.#future.at(-1)?.label ?? null;
  }

  /** Makes `next` the present and one step of the past; the same state again is no step. */
  push(next: T, label: string): void {
    if (this.#captured) this.commit(label);
    if (Object.is(next, this.#present)) return;
    this.#record(this.#present, label);
    this.#present = next;
  }

  /** Begins a grouped change; a capture that is still open is committed first. */
  capture(): void {
    if (this.#captured) this.commit('Change');
    this.#captured = { state: this.#present };
  }

  /** Shows `next` without making a step. Outside a capture it is an error of the caller. */
  preview(next: T): void {
    if (!this.#captured) throw new Error('History.preview needs a capture: call capture() first.');
    this.#present = next;
  }

  /** Ends the capture and makes one step of all that was previewed. */
  commit(label: string): void {
    const captured = this.#captured;
    this.#captured = null;
    if (captured && !Object.is(captured.state, this.#present)) this.#record(captured.state, label);
  }

  /** Ends the capture and goes back to where it began. */
  discard(): void {
    if (this.#captured) this.#present = this.#captured.state;
    this.#captured = null;
  }

  /** Goes one step back; inside a capture it only discards that. Returns false when there is nothing to undo. */
  undo(): boolean {
    if (this.#captured) {
      this.discard();
      return true;
    }
    const step = this.#past.pop();
    if (!step) return false;
    this.#future.push({ state: this.#present, label: step.label });
    this.#present = step.state;
    return true;
  }

  /** Goes one step forward again. Returns false when there is nothing to redo. */
  redo(): boolean {
    if (this.#captured) this.discard();
    const step = this.#future.pop();
    if (!step) return false;
    this.#past.push({ state: this.#present, label: step.label });
    this.#present = step.state;
    return true;
  }

  /** Changes what undo does not cover, such as the camera, in every state at once: no step, and redo stays. */
  amend(edit: (state: T) => T): void {
    const change = (step: Step<T>) => ({ ...step, state: edit(step.state) });
    this.#past = this.#past.map(change);
    this.#future = this.#future.map(change);
    const before = this.#present;
    this.#present = edit(before);
    if (!this.#captured) return;
    // A capture in which nothing has changed yet must stay one in which nothing has changed.
    const untouched = Object.is(this.#captured.state, before);
    this.#captured = { state: untouched ? this.#present : edit(this.#captured.state) };
  }

  /** Takes the last step back for good: something failed, and redo must not bring it again. */
  abandon(): void {
    const step = this.#past.pop();
    if (step) this.#present = step.state;
  }

  /** Forgets everything and starts at `initial`. */
  reset(initial: T): void {
    this.#past = [];
    this.#future = [];
    this.#captured = null;
    this.#present = initial;
  }

  #record(state: T, label: string): void {
    this.#past.push({ state, label });
    if (this.#past.length > this.#limit) this.#past.shift();
    this.#future = [];
  }
}
