import { vi } from 'vitest';

/** A worker that answers as the test says. */
export class FakeWorker<Request, Reply> {
  onmessage: ((event: MessageEvent<Reply>) => void) | null = null;
  onerror: ((event: ErrorEvent) => void) | null = null;
  sent: Request[] = [];
  terminate = vi.fn();
  postMessage(request: Request) {
    this.sent.push(request);
  }
  reply(reply: Reply) {
    this.onmessage?.({ data: reply } as MessageEvent<Reply>);
  }
}
