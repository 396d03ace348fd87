import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import { axisAngleToEuler, eulerToAxisAngle } from '../../web/app/euler';
import { angleBetween, axisAngleToQuaternion } from '../../web/core/rotation';
import { createDocument } from '../../web/core/document';
import { parseDocument } from '../../web/core/document-read';
import { History } from '../../web/core/history';

const angle = fc.double({ min: -3, max: 3, noNaN: true });

describe('x y z degrees', () => {
  it('say the same rotation as the axis-angle they came from', () => {
    fc.assert(
      fc.property(fc.tuple(angle, angle, angle), (turn) => {
        const back = eulerToAxisAngle(axisAngleToEuler(turn));
        expect(angleBetween(axisAngleToQuaternion(turn), axisAngleToQuaternion(back))).toBeLessThan(2e-3);
      }),
    );
  });
  it('come back as typed while y stays within 89 degrees', () => {
    const degrees = (limit: number) => fc.double({ min: -limit, max: limit, noNaN: true });
    fc.assert(
      fc.property(fc.tuple(degrees(179), degrees(89), degrees(179)), (typed) => {
        axisAngleToEuler(eulerToAxisAngle(typed)).forEach((value, i) => expect(value).toBeCloseTo(typed[i], 4));
      }),
    );
  });
});

describe('parseDocument', () => {
  it('never throws anything but a clear Error, whatever it gets', () => {
    fc.assert(
      fc.property(fc.jsonValue(), fc.jsonValue(), fc.jsonValue(), (keyPoses, dials, song) => {
        const { document } = parseDocument({ format: 'posebeat', version: 1, keyPoses, dials, song });
        expect(parseDocument(JSON.parse(JSON.stringify(document)))).toEqual({ document, repairs: [] });
      }),
    );
    fc.assert(
      fc.property(fc.jsonValue(), (anything) => {
        expect(() => parseDocument(anything)).toThrow(/Posebeat project/);
      }),
    );
  });
  it('has nothing to repair in a new document', () => {
    expect(parseDocument(createDocument()).repairs).toEqual([]);
  });
});

describe('History', () => {
  it('after any actions, undoing everything gives the first state and redoing the last', () => {
    const action = fc.oneof(
      fc.record({ type: fc.constant('push' as const), value: fc.integer() }),
      fc.record({ type: fc.constant('drag' as const), value: fc.integer(), keep: fc.boolean() }),
      fc.record({ type: fc.constant('undo' as const) }),
      fc.record({ type: fc.constant('redo' as const) }),
    );
    fc.assert(
      fc.property(fc.array(action, { maxLength: 60 }), (actions) => {
        const history = new History({ value: 0 });
        const first = history.present;
        for (const each of actions) {
          if (each.type === 'push') history.push({ value: each.value }, 'push');
          else if (each.type === 'undo') history.undo();
          else if (each.type === 'redo') history.redo();
          else {
            history.capture();
            history.preview({ value: each.value });
            if (each.keep) history.commit('drag');
            else history.discard();
          }
        }
        while (history.redo());
        const last = history.present;
        while (history.undo());
        expect(history.present).toBe(first);
        while (history.redo());
        expect(history.present).toBe(last);
      }),
    );
  });
});
