/** Measures dances, finishes them at another key strength and plots the trade-off, off the main thread. */
import { ReportDesk } from './report-desk';
import type { ReportRequest } from './report-protocol';

/** Lets messages in; a timer would wait 4 ms even for nothing. */
function pause(milliseconds: number): Promise<void> {
  return new Promise((resolve) => {
    if (milliseconds > 0) {
      setTimeout(resolve, milliseconds);
      return;
    }
    const channel = new MessageChannel();
    channel.port1.onmessage = () => {
      channel.port1.close();
      resolve();
    };
    channel.port2.postMessage(null);
  });
}

const desk = new ReportDesk({ reply: (message, transfer) => self.postMessage(message, { transfer }), pause });

self.onmessage = ({ data }: MessageEvent<ReportRequest>) => desk.handle(data);
