import { describe, expect, it, vi } from 'vitest';
import type { PosebeatApi } from '../../web/app/api';
import { answerMessages, embedSnippet, embedWish, type Frame } from '../../web/app/embed';

const HOST = 'https://host.example';

/** A frame inside a page of `origin`, and what it sends there. */
function framed(allowed: string | null = null, api: Partial<PosebeatApi> = {}) {
  const sent: { message: Record<string, unknown>; to: string }[] = [];
  const parent = { postMessage: (message: unknown, to: string) => void sent.push({ message: message as never, to }) };
  let listener: (event: MessageEvent) => void = () => undefined;
  const frame: Frame = { parent, addEventListener: (_, added) => (listener = added) };
  const whole = { ready: Promise.resolve(), document: () => ({ format: 'posebeat' }), ...api } as PosebeatApi;
  answerMessages(whole, frame, allowed);
  const receive = async (data: unknown, origin = HOST, source: unknown = parent) => {
    const ticks = async () => {
      for (let i = 0; i < 10; i += 1) await Promise.resolve();
    };
    await ticks();
    sent.length = 0;
    listener({ data, origin, source } as MessageEvent);
    await ticks();
    return sent;
  };
  return { sent, receive };
}

describe('a page inside another one', () => {
  it('says once that it is ready', async () => {
    const { sent } = framed();
    await Promise.resolve();
    expect(sent).toEqual([{ message: { posebeat: 1, event: 'ready' }, to: '*' }]);
    const named = framed(HOST);
    await Promise.resolve();
    expect(named.sent[0].to).toBe(HOST);
  });

  it('answers with what the method of that name gives, to the origin that asked', async () => {
    const generate = vi.fn(() => Promise.resolve({ frames: 300 } as never));
    const { receive } = framed(null, { generate });
    expect(await receive({ posebeat: 1, id: 7, method: 'generate', arguments: [{ seed: 3 }] })).toEqual([
      { message: { posebeat: 1, id: 7, result: { frames: 300 } }, to: HOST },
    ]);
    expect(generate).toHaveBeenCalledWith({ seed: 3 });
    const [{ message }] = await receive({ posebeat: 1, id: 'a', method: 'document' });
    expect(message).toEqual({ posebeat: 1, id: 'a', result: { format: 'posebeat' } });
  });

  it('refuses what it does not know, and what a method refuses, in a sentence', async () => {
    const setKeyPoses = () => {
      throw new Error('Key poses must be a list of {time, rotations}.');
    };
    const { receive } = framed(null, { setKeyPoses });
    const error = async (data: object) => (await receive({ posebeat: 1, id: 1, ...data }))[0].message.error;
    expect(await error({ method: 'destroy' })).toBe('There is no method “destroy”: use one of document, setKeyPoses.');
    for (const method of ['constructor', '__proto__', 'toString', 'ready', 5, null]) {
      expect(await error({ method })).toMatch(/^There is no method “.*”: use one of document, setKeyPoses\.$/);
    }
    expect(await error({ method: 'document', arguments: 'x' })).toBe('The arguments must be a list.');
    expect(await error({ method: 'document', posebeat: 2 })).toMatch(/^There is no message form 2: send \{posebeat: 1/);
    expect(await error({ method: 'setKeyPoses', arguments: [1] })).toBe(
      'Key poses must be a list of {time, rotations}.',
    );
  });

  it('says so when an answer cannot travel', async () => {
    const parent = {
      postMessage: vi.fn((message: { result?: unknown }) => {
        if ('result' in message) throw new DOMException('could not be cloned', 'DataCloneError');
      }),
    };
    let listener: (event: MessageEvent) => void = () => undefined;
    const api = { ready: Promise.resolve(), document: () => () => 1 } as unknown as PosebeatApi;
    answerMessages(api, { parent, addEventListener: (_, added) => (listener = added) }, null);
    listener({ data: { posebeat: 1, id: 1, method: 'document' }, origin: HOST, source: parent } as never);
    await vi.waitFor(() =>
      expect(parent.postMessage).toHaveBeenCalledWith({ posebeat: 1, id: 1, error: 'could not be cloned' }, HOST),
    );
  });

  it('listens to the page around only, and only of the origin that was named', async () => {
    const ask = { posebeat: 1, id: 1, method: 'document' };
    const { receive } = framed(HOST);
    expect(await receive(ask)).toHaveLength(1);
    expect(await receive(ask, 'https://host.example.evil.org')).toEqual([]);
    expect(await receive(ask, HOST, { postMessage: () => undefined })).toEqual([]);
    expect(await receive(ask, 'null')).toEqual([]);
    const open = framed();
    expect(await open.receive(ask, 'https://any.example')).toHaveLength(1);
    expect((await open.receive(ask, 'null'))[0].to).toBe('*');
    for (const other of [null, 'hi', 5, {}, { posebeat: 1 }, { method: 'document' }]) {
      expect(await open.receive(other)).toEqual([]);
    }
  });
});

describe('the address of a frame', () => {
  it('says whether it is one and who may drive it', () => {
    expect(embedWish('')).toEqual({ embedded: false, origin: null });
    expect(embedWish('?embed=0&origin=x')).toEqual({ embedded: false, origin: null });
    expect(embedWish('?embed=1')).toEqual({ embedded: true, origin: null });
    expect(embedWish(`?embed=1&origin=${encodeURIComponent(HOST)}`)).toEqual({ embedded: true, origin: HOST });
    expect(embedWish('?embed=1&origin=http://localhost:8080/').origin).toBe('http://localhost:8080');
    for (const wrong of ['', 'host.example', '*', 'null', 'https://host.example/path', 'data:text/html,x']) {
      expect(() => embedWish(`?embed=1&origin=${encodeURIComponent(wrong)}`)).toThrow('is no origin');
    }
  });

  it('is put into a snippet that cannot break out of it', () => {
    const snippet = embedSnippet('https://host.example/a"><script>/#d=1.abc');
    expect(snippet).toMatch(/^<iframe src="https:\/\/host\.example\/a[^"<>]*\?embed=1#d=1\.abc" /);
    expect(snippet.match(/</g)).toHaveLength(2);
  });
});
