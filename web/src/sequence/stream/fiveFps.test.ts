// @vitest-environment node
import { create } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { type StreamItem, StreamItemSchema } from '../../gen/visionserver/v1/stream_pb';
import { LiveStream } from './liveStream';
import { Multiplexer } from './multiplexer';
import { settle } from './testing';
import type { AckItem, SubscriptionInit, Transport } from './transport';

const kFrameMs = 33;
// From exposure to published, as the demonstration has it; and one way through the network.
const kPipelineMs = 50;
const kNetworkMs = 3;

/** A server, a network and a page with one thread, in simulated time. */
class Simulation implements Transport {
  now_ms = 0;
  shown: number[] = [];
  private readonly events: { time_ms: number; onPage: boolean; call: () => void }[] = [];
  private pageBusyUntil_ms = 0;
  private newest: { seq: number; capture_ms: number } | undefined;
  private window = 2;
  private unacknowledged: number[] = [];
  private sent = 0;
  acks = 0;
  private deliver: (item: StreamItem) => void = () => undefined;

  at(time_ms: number, onPage: boolean, call: () => void): void {
    this.events.push({ time_ms, onPage, call });
  }

  /** The page's thread does nothing else for so long. */
  block(duration_ms: number): void {
    this.now_ms += duration_ms;
    this.pageBusyUntil_ms = this.now_ms;
  }

  async run(until_ms: number): Promise<void> {
    for (;;) {
      const timeOf = (event: (typeof this.events)[number]) =>
        event.onPage ? Math.max(event.time_ms, this.pageBusyUntil_ms) : event.time_ms;
      const next = this.events.reduce((a, b) => (timeOf(b) < timeOf(a) ? b : a));
      if (timeOf(next) > until_ms) return;
      this.events.splice(this.events.indexOf(next), 1);
      this.now_ms = timeOf(next);
      next.call();
      await settle();
    }
  }

  publish(seq: number): void {
    const published_ms = seq * kFrameMs + kPipelineMs;
    this.at(published_ms, false, () => {
      this.newest = { seq, capture_ms: seq * kFrameMs };
      this.publish(seq + 1);
      this.sendNewest();
    });
  }

  async *subscribe(wanted: SubscriptionInit[]): AsyncGenerator<StreamItem> {
    this.window = wanted[0]!.window!;
    const items: StreamItem[] = [create(StreamItemSchema, { streamId: 'one' })];
    let wake = () => {};
    this.deliver = (item) => {
      items.push(item);
      wake();
    };
    this.publish(1);
    for (;;) {
      const item = items.shift();
      if (item) yield item;
      else await new Promise<void>((resolve) => (wake = resolve));
    }
  }

  update(_id: string, set: SubscriptionInit[]): Promise<void> {
    this.at(this.now_ms + kNetworkMs, false, () => {
      // As the server does: a changed subscription begins with full credit.
      this.window = set[0]!.window!;
      this.unacknowledged = [];
      this.sendNewest();
    });
    return Promise.resolve();
  }

  ack(_id: string, [item]: AckItem[]): Promise<void> {
    ++this.acks;
    return new Promise((resolve) => {
      this.at(this.now_ms + kNetworkMs, false, () => {
        this.unacknowledged = this.unacknowledged.filter((seq) => seq > Number(item!.seq));
        this.sendNewest();
        this.at(this.now_ms + kNetworkMs, true, resolve);
      });
    });
  }

  private sendNewest(): void {
    const { newest } = this;
    if (!newest || newest.seq === this.sent || this.unacknowledged.length >= this.window) return;
    this.sent = newest.seq;
    this.unacknowledged.push(newest.seq);
    const item = create(StreamItemSchema, {
      subscriptionId: 1,
      seq: BigInt(newest.seq),
      header: { captureNs: BigInt(newest.capture_ms * 1e6) },
    });
    this.at(this.now_ms + kNetworkMs, true, () => this.deliver(item));
  }
}

/**
 * Drawn pictures' ages when they are on the screen, milliseconds, after the first 3 s; and how often
 * the page has acknowledged since its beginning.
 */
async function watch(page: {
  draw_ms: number;
  frame_ms: number;
}): Promise<{ ages_ms: number[]; acks: number }> {
  const simulation = new Simulation();
  const mux = new Multiplexer(simulation, {
    after: (delay_ms, call) => {
      simulation.at(simulation.now_ms + delay_ms, true, call);
      return () => undefined;
    },
  });
  const ages_ms: number[] = [];
  new LiveStream(
    mux,
    {
      wanted: { stream: 'cell/depth' },
      decode: (item) => Promise.resolve(Number(item.header!.captureNs) / 1e6),
      draw: (capture_ms) => {
        simulation.block(page.draw_ms);
        if (simulation.now_ms > 3000) ages_ms.push(simulation.now_ms - capture_ms);
      },
    },
    {
      now_ms: () => simulation.now_ms,
      serverNow_ns: () => BigInt(Math.round(simulation.now_ms * 1e6)),
      nextFrame: (draw) => {
        const next = (Math.floor(simulation.now_ms / page.frame_ms) + 1) * page.frame_ms;
        simulation.at(next, true, draw);
      },
    },
  );
  await settle();
  await simulation.run(13_000);
  return { ages_ms, acks: simulation.acks };
}

describe('A page that draws only five pictures a second', () => {
  it('stays less than 0.3 s behind when drawing itself takes 0.2 s', async () => {
    const { ages_ms } = await watch({ draw_ms: 200, frame_ms: 16 });
    expect(ages_ms.length).toBeGreaterThan(35);
    expect(Math.max(...ages_ms)).toBeLessThan(300);
  });

  it('stays less than 0.15 s behind when the browser lets it draw every 0.2 s', async () => {
    const { ages_ms } = await watch({ draw_ms: 1, frame_ms: 200 });
    expect(ages_ms.length).toBeGreaterThan(45);
    expect(Math.max(...ages_ms)).toBeLessThan(150);
  });
});

describe('A quick page', () => {
  it('draws all pictures, 0.1 s old at most', async () => {
    const { ages_ms, acks } = await watch({ draw_ms: 2, frame_ms: 16 });
    expect(ages_ms.length).toBeGreaterThanOrEqual(Math.floor(10_000 / kFrameMs));
    expect(Math.max(...ages_ms)).toBeLessThan(100);
    // 13 s long.
    expect(acks).toBeLessThan((0.7 * 13_000) / kFrameMs);
  });
});
