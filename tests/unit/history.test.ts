import { describe, expect, it } from 'vitest';
import { History } from '../../web/core/history';

describe('History', () => {
  it('goes back and forward through 250 steps to the same states', () => {
    const history = new History({ n: 0 });
    const states = [history.present];
    for (let n = 1; n <= 250; n += 1) {
      history.push({ n }, `step ${n}`);
      states.push(history.present);
    }
    for (let n = 249; n >= 0; n -= 1) {
      expect(history.undo()).toBe(true);
      expect(history.present).toBe(states[n]);
    }
    expect(history.undo()).toBe(false);
    for (let n = 1; n <= 250; n += 1) {
      expect(history.redo()).toBe(true);
      expect(history.present).toBe(states[n]);
    }
    expect(history.redo()).toBe(false);
  });

  it('makes one step of a whole drag', () => {
    const history = new History(0);
    history.capture();
    for (let n = 1; n <= 40; n += 1) history.preview(n);
    history.commit('Move');
    expect(history.present).toBe(40);
    expect(history.undoLabel).toBe('Move');
    history.undo();
    expect(history.present).toBe(0);
    expect(history.undoLabel).toBeNull();
  });

  it('keeps redo when a drag is discarded or changes nothing', () => {
    const history = new History(0);
    history.push(1, 'one');
    history.undo();
    history.capture();
    history.preview(7);
    history.discard();
    expect(history.present).toBe(0);
    history.capture();
    history.preview(5);
    history.preview(0);
    history.commit('nothing');
    expect(history.redoLabel).toBe('one');
    history.redo();
    expect(history.present).toBe(1);
  });

  it('only discards the drag when undo comes in the middle of it', () => {
    const history = new History(0);
    history.push(1, 'one');
    history.capture();
    history.preview(9);
    expect(history.undo()).toBe(true);
    expect(history.present).toBe(1);
    expect(history.undoLabel).toBe('one');
  });

  it('drops the oldest steps beyond its limit', () => {
    const history = new History(0, 3);
    for (let n = 1; n <= 5; n += 1) history.push(n, String(n));
    while (history.undo());
    expect(history.present).toBe(2);
  });

  it('refuses a preview outside a drag', () => {
    expect(() => new History(0).preview(1)).toThrow(/capture/);
  });

  it('amends every state without a step, and redo stays', () => {
    const history = new History({ pose: 0, camera: 'near' });
    for (const pose of [1, 2, 3]) history.push({ ...history.present, pose }, `${pose}`);
    history.undo();
    history.amend((state) => ({ ...state, camera: 'far' }));
    expect(history.present).toEqual({ pose: 2, camera: 'far' });
    expect(history.redo()).toBe(true);
    expect(history.present).toEqual({ pose: 3, camera: 'far' });
    for (let n = 0; n < 3; n += 1) history.undo();
    expect(history.present).toEqual({ pose: 0, camera: 'far' });
    expect(history.undo()).toBe(false);
  });

  it('amends inside a drag that has not moved yet without making it a step', () => {
    const history = new History({ pose: 0, camera: 'near' });
    history.capture();
    history.amend((state) => ({ ...state, camera: 'far' }));
    history.commit('Drag');
    expect(history.undoLabel).toBeNull();
    history.capture();
    history.preview({ ...history.present, pose: 1 });
    history.amend((state) => ({ ...state, camera: 'left' }));
    history.discard();
    expect(history.present).toEqual({ pose: 0, camera: 'left' });
  });
});
