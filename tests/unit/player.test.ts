import { describe, expect, it } from 'vitest';
import { HeardClock } from '../../web/audio/heard-clock';
import { Player } from '../../web/audio/player';

interface Started {
  when: number;
  offset: number;
  loop: [number, number] | null;
  rate: number;
  /** Seconds of the song after which the sound ends by itself. */
  length?: number;
}

/** An AudioContext whose hardware runs at `1 + skew` times the page's clock, in steps of a render buffer, `latency` behind. */
class FakeDevice {
  now = 1000;
  state: 'suspended' | 'running' = 'suspended';
  started: Started[] = [];
  stampBroken = false;
  #startedAt = 0;
  #frozen = 0;
  #listener: () => void = () => undefined;
  constructor(
    readonly latency = 0.08,
    readonly skew = 0,
  ) {}

  get exact(): number {
    return this.state === 'running' ? ((this.now - this.#startedAt) / 1000) * (1 + this.skew) : this.#frozen;
  }
  get context(): AudioContext {
    // eslint-disable-next-line @typescript-eslint/no-this-alias
    const device = this;
    const parameter = { value: 1, setValueAtTime: () => 0, linearRampToValueAtTime: () => 0, setTargetAtTime: () => 0 };
    const gain = () => ({ gain: parameter, connect: (next: unknown) => next, disconnect: () => undefined });
    return {
      get currentTime() {
        return Math.floor(device.exact / 0.01) * 0.01;
      },
      get state() {
        return device.state;
      },
      get outputLatency() {
        return device.latency;
      },
      getOutputTimestamp: () =>
        device.stampBroken
          ? { contextTime: 0, performanceTime: 0 }
          : { contextTime: device.exact - device.latency, performanceTime: device.now },
      destination: {},
      createGain: gain,
      createBufferSource: () => {
        const node = {
          playbackRate: { value: 1 },
          loop: false,
          loopStart: 0,
          loopEnd: 0,
          buffer: null,
          connect: (next: unknown) => next,
          start: (when: number, offset: number, length?: number) =>
            device.started.push({
              when,
              offset,
              length,
              loop: node.loop ? [node.loopStart, node.loopEnd] : null,
              rate: node.playbackRate.value,
            }),
          stop: () => undefined,
        };
        return node;
      },
      resume: () => Promise.resolve(),
      close: () => Promise.resolve(),
      addEventListener: (_: string, listener: () => void) => {
        device.#listener = listener;
      },
    } as unknown as AudioContext;
  }
  run(): void {
    this.state = 'running';
    this.#startedAt = this.now;
    this.#listener();
  }
  suspend(): void {
    this.#frozen = this.exact;
    this.state = 'suspended';
    this.#listener();
  }
  /** What really leaves the speakers now, from the last source that is already heard. */
  heard(): number {
    const at = this.exact - this.latency;
    const source = this.started.filter((each) => each.when <= at).at(-1)!;
    const position = source.offset + (at - source.when) * source.rate;
    if (!source.loop || position < source.loop[1]) return position;
    return source.loop[0] + ((position - source.loop[0]) % (source.loop[1] - source.loop[0]));
  }
}

const buffer = (duration = 200) => ({ duration }) as AudioBuffer;

function playing(device: FakeDevice, duration = 200): Player {
  const player = new Player(
    () => device.context,
    () => device.now,
  );
  player.load(duration, buffer(duration));
  player.unlock();
  device.run();
  return player;
}

describe('Player', () => {
  it.each([
    ['an honest device', 0],
    ['a device 300 ppm fast', 3e-4],
    ['a device 300 ppm slow', -3e-4],
  ])('stays within a frame of the sound for three minutes on %s', (_name, skew) => {
    const device = new FakeDevice(0.08, skew);
    const player = playing(device);
    player.play();
    let worst = 0;
    let last = 0;
    for (let ms = 0; ms < 180_000; ms += 16.6) {
      device.now += 16.6;
      const time = player.time();
      expect(time).toBeGreaterThanOrEqual(last - 1e-9);
      last = time;
      if (ms > 500) worst = Math.max(worst, Math.abs(time - device.heard()));
    }
    expect(last).toBeGreaterThan(179);
    expect(worst).toBeLessThan(1 / 30);
  });

  it('trusts the reported latency when output timestamps are useless', () => {
    const device = new FakeDevice(0.12);
    device.stampBroken = true;
    const player = playing(device);
    player.play();
    for (let ms = 0; ms < 5000; ms += 16) {
      device.now += 16;
      player.time();
    }
    expect(Math.abs(player.time() - device.heard())).toBeLessThan(1 / 30);
  });

  it('runs on the timer while sound is locked and hands over without a jump', () => {
    const device = new FakeDevice(0.1);
    const player = new Player(
      () => device.context,
      () => device.now,
    );
    player.load(60, null);
    player.setMuted(true);
    player.play();
    device.now += 2000;
    expect(player.time()).toBeCloseTo(2, 6);
    expect(player.clock).toBe('timer');
    player.attach(buffer(60));
    player.setMuted(false);
    device.now += 50;
    let before = player.time();
    device.run();
    for (let ms = 0; ms < 2000; ms += 4) {
      device.now += 4;
      const time = player.time();
      expect(Math.abs(time - before - 0.004)).toBeLessThan(0.003);
      before = time;
    }
    expect(player.clock).toBe('audio');
    expect(Math.abs(player.time() - device.heard())).toBeLessThan(0.005);
    expect(player.time()).toBeCloseTo(4.05, 2);
  });

  it('goes on silently when the device is taken away', () => {
    const device = new FakeDevice();
    const player = playing(device);
    player.play();
    device.now += 3000;
    const before = player.time();
    device.suspend();
    device.now += 1000;
    expect(player.clock).toBe('timer');
    expect(Math.abs(player.time() - before - 1)).toBeLessThan(0.01);
  });

  it('changes speed without a jump of what is heard', () => {
    const device = new FakeDevice(0.1);
    const player = playing(device);
    player.play();
    for (let ms = 0; ms < 3000; ms += 10) {
      device.now += 10;
      player.time();
    }
    player.setSpeed(0.5);
    let before = player.time();
    for (let ms = 0; ms < 2000; ms += 10) {
      device.now += 10;
      const time = player.time();
      expect(time - before).toBeGreaterThan(0.003);
      expect(time - before).toBeLessThan(0.012);
      before = time;
      expect(Math.abs(time - device.heard())).toBeLessThan(0.01);
    }
    expect(device.started.at(-1)!.rate).toBe(0.5);
  });

  it('loops where the sound loops', () => {
    const device = new FakeDevice(0.05);
    const player = playing(device);
    player.setLoop({ start: 4, end: 6 });
    player.seek(5);
    player.play();
    let lowest = Infinity;
    for (let ms = 0; ms < 9000; ms += 10) {
      device.now += 10;
      const time = player.time();
      if (ms > 500) {
        expect(Math.abs(time - device.heard()) % 2).toBeLessThan(0.01);
        lowest = Math.min(lowest, time);
        expect(time).toBeLessThan(6);
      }
    }
    expect(lowest).toBeGreaterThanOrEqual(4);
    expect(lowest).toBeLessThan(4.02);
  });

  it('seeks, pauses and ends where it should', () => {
    const device = new FakeDevice();
    const player = playing(device, 10);
    player.seek(99);
    expect(player.time()).toBe(10);
    player.seek(-1);
    expect(player.time()).toBe(0);
    player.seek(8);
    player.play();
    expect(player.time()).toBeCloseTo(8, 6);
    device.now += 1000;
    player.pause();
    const paused = player.time();
    device.now += 5000;
    expect(player.time()).toBe(paused);
    player.play();
    device.now += 5000;
    expect(player.time()).toBe(10);
    player.tick();
    expect(player.playing).toBe(false);
    player.play();
    expect(player.time()).toBe(0);
  });

  it('plays, seeks, loops and ends inside its bounds', () => {
    const device = new FakeDevice();
    const player = playing(device, 20);
    player.setBounds({ start: 4, end: 8 });
    expect(player.time()).toBe(4);
    player.seek(1);
    expect(player.time()).toBe(4);
    player.seek(15);
    expect(player.time()).toBe(8);
    player.play();
    expect(player.time()).toBe(4);
    expect(device.started.at(-1)!.length).toBe(4);
    device.now += 5000;
    expect(player.time()).toBe(8);
    player.tick();
    expect(player.playing).toBe(false);
    player.setLoop({ start: 6, end: 12 });
    expect(player.loop).toEqual({ start: 6, end: 8 });
    player.setBounds({ start: 10, end: 14 });
    expect(player.loop).toBeNull();
    expect(player.time()).toBe(10);
    player.setBounds(null);
    player.seek(19);
    expect(player.time()).toBe(19);
  });

  it('goes on without a jump when its bounds change around the playhead, and begins anew when they leave it', () => {
    const device = new FakeDevice();
    const player = playing(device, 20);
    player.seek(5);
    player.play();
    device.now += 1000;
    const before = player.time();
    player.setBounds({ start: 2, end: 9 });
    expect(player.time()).toBeCloseTo(before, 2);
    expect(device.started.at(-1)!.length).toBeCloseTo(9 - before, 0);
    player.setBounds({ start: 12, end: 15 });
    expect(player.time()).toBe(12);
    expect(player.playing).toBe(true);
  });

  it('takes bounds that hold the whole song for none, and forgets them with the song', () => {
    const player = playing(new FakeDevice(), 20);
    player.setBounds({ start: -1, end: 30 });
    expect(player.bounds).toBeNull();
    player.setBounds({ start: 3, end: 30 });
    expect(player.bounds).toEqual({ start: 3, end: 20 });
    player.load(10, buffer(10));
    expect(player.bounds).toBeNull();
  });

  it('keeps speed in its range and ignores loops too short to hear', () => {
    const player = playing(new FakeDevice());
    player.setSpeed(9);
    expect(player.speed).toBe(1.5);
    player.setSpeed(0);
    expect(player.speed).toBe(0.25);
    player.setLoop({ start: 1, end: 1.01 });
    expect(player.loop).toBeNull();
  });
});

describe('HeardClock', () => {
  it('smooths the steps of a render buffer away', () => {
    const clock = new HeardClock();
    let now = 0;
    let worst = 0;
    let last = 0;
    for (let i = 0; i < 400; i += 1) {
      now += 16;
      const heard = clock.read({ currentTime: Math.floor(now / 1000 / 0.02) * 0.02, outputLatency: 0.05 }, now);
      if (i > 100) worst = Math.max(worst, Math.abs(heard - last - 0.016));
      last = heard;
    }
    expect(worst).toBeLessThan(0.002);
  });
});
