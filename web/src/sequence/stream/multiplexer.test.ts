// @vitest-environment node
import { create } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { StreamItemSchema } from '../../gen/visionserver/v1/stream_pb';
import { Multiplexer, type Timers } from './multiplexer';
import { FakeTransport, settle } from './testing';

class ManualTimers implements Timers {
  waiting: { delay_ms: number; call: () => void }[] = [];

  after(delay_ms: number, call: () => void): () => void {
    const timer = { delay_ms, call };
    this.waiting.push(timer);
    return () => {
      this.waiting = this.waiting.filter((other) => other !== timer);
    };
  }

  async run(): Promise<void> {
    const due = this.waiting;
    this.waiting = [];
    for (const { call } of due) call();
    await settle();
  }
}

function setUp() {
  const transport = new FakeTransport();
  const timers = new ManualTimers();
  const mux = new Multiplexer(transport, timers);
  const seen: string[] = [];
  const watch = (stream: string, window?: number) =>
    mux.subscribe(
      { stream, window },
      {
        onItem: (item) => seen.push(`${stream} ${item.seq}`),
        onNotice: (text) => seen.push(`${stream}: ${text}`),
      },
    );
  return { transport, timers, mux, seen, watch };
}

describe('Multiplexer', () => {
  it('opens one stream for all that is wanted at first', async () => {
    const { transport, watch } = setUp();
    watch('a/depth');
    watch('a/left');
    await settle();
    expect(transport.streams).toHaveLength(1);
    expect(transport.streams[0]!.wanted.map(({ id, stream }) => [id, stream])).toEqual([
      [1, 'a/depth'],
      [2, 'a/left'],
    ]);
  });

  it('gives each item to its subscriber', async () => {
    const { transport, seen, watch } = setUp();
    watch('a/depth');
    watch('a/left');
    await settle();
    await transport.send({ streamId: 's1' });
    await transport.send({ subscriptionId: 2, seq: 7n });
    await transport.send({ subscriptionId: 1, notice: 'not running' });
    await transport.send({ subscriptionId: 9, seq: 8n });
    expect(seen).toEqual(['a/left 7', 'a/depth: not running']);
  });

  it('tells the server of what comes and goes, in one call at a time', async () => {
    const { transport, watch } = setUp();
    const first = watch('a/depth');
    await settle();
    await transport.send({ streamId: 's1' });
    watch('a/left');
    first.end();
    await settle();
    expect(transport.updates).toEqual([
      { streamId: 's1', set: [{ id: 2, stream: 'a/left' }], remove: [1] },
    ]);
    const third = watch('a/right');
    await settle();
    third.change({ stream: 'a/right', maxFps: 5 });
    await settle();
    expect(transport.updates).toHaveLength(1);
    await transport.answerUpdate();
    await transport.answerUpdate();
    expect(transport.updates.slice(1)).toEqual([
      { streamId: 's1', set: [{ id: 3, stream: 'a/right', maxFps: 5 }], remove: [] },
    ]);
  });

  it('acknowledges together what is drawn together, one call at a time', async () => {
    const { transport, timers, watch } = setUp();
    const a = watch('a/depth');
    const b = watch('a/left');
    await settle();
    await transport.send({ streamId: 's1' });
    a.acknowledge(4n);
    b.acknowledge(5n);
    a.acknowledge(6n);
    await timers.run();
    const both = [
      { subscriptionId: 1, seq: 6n },
      { subscriptionId: 2, seq: 5n },
    ];
    expect(transport.acks).toEqual([both]);
    a.acknowledge(7n);
    await timers.run();
    expect(transport.acks).toEqual([both]);
    await transport.answerAck();
    expect(transport.acks).toEqual([both, [{ subscriptionId: 1, seq: 7n }]]);
  });

  it('gathers acknowledgements where there is credit to go on, until one is urgent', async () => {
    const { transport, timers, watch } = setUp();
    const patient = watch('a/depth', 5);
    const urgent = watch('a/left', 1);
    await settle();
    await transport.send({ streamId: 's1' });
    patient.acknowledge(1n);
    patient.acknowledge(2n);
    expect(timers.waiting.map(({ delay_ms }) => delay_ms)).toEqual([50]);
    urgent.acknowledge(3n);
    patient.acknowledge(4n);
    expect(timers.waiting.map(({ delay_ms }) => delay_ms)).toEqual([0]);
    await timers.run();
    expect(transport.acks).toEqual([
      [
        { subscriptionId: 1, seq: 4n },
        { subscriptionId: 2, seq: 3n },
      ],
    ]);
  });

  it('asks for nothing while nobody looks, and for all of it afterwards', async () => {
    const { transport, timers, mux, watch } = setUp();
    watch('a/depth');
    await settle();
    await transport.send({ streamId: 's1' });
    mux.setActive(false);
    await settle();
    expect(transport.streams[0]!.signal.aborted).toBe(true);
    expect(mux.connection).toBe('closed');
    await timers.run();
    watch('a/left');
    await settle();
    expect(transport.streams).toHaveLength(1);
    mux.setActive(true);
    await settle();
    expect(transport.streams).toHaveLength(2);
    expect(transport.streams[1]!.wanted.map(({ stream }) => stream)).toEqual(['a/depth', 'a/left']);
  });

  it('closes the stream when nobody wants anything any more', async () => {
    const { transport, mux, watch } = setUp();
    const only = watch('a/depth');
    await settle();
    only.end();
    await settle();
    expect(transport.streams[0]!.signal.aborted).toBe(true);
    expect(mux.connection).toBe('closed');
  });

  it('comes back after the server went, with growing delays until it is there', async () => {
    const { transport, timers, mux, watch } = setUp();
    watch('a/depth');
    await settle();
    await transport.send({ streamId: 's1' });
    await transport.fail();
    expect(mux.connection).toBe('waiting');
    const delays_ms: number[] = [];
    for (let attempt = 1; attempt <= 7; ++attempt) {
      delays_ms.push(timers.waiting[0]!.delay_ms);
      await timers.run();
      expect(transport.streams).toHaveLength(attempt + 1);
      await transport.fail();
    }
    // Each within the upper half of 250, 500, 1000, 2000, 4000, 5000, 5000 ms.
    [250, 500, 1000, 2000, 4000, 5000, 5000].forEach((limit_ms, i) => {
      expect(delays_ms[i]).toBeLessThanOrEqual(limit_ms);
      expect(delays_ms[i]).toBeGreaterThanOrEqual(limit_ms / 2);
    });
    await timers.run();
    await transport.send({ streamId: 's9' });
    expect(mux.connection).toBe('open');
    await transport.fail();
    expect(timers.waiting[0]!.delay_ms).toBeLessThanOrEqual(250);
  });

  it('opens the stream at once when it hears that the server is back', async () => {
    const { transport, timers, mux, watch } = setUp();
    watch('a/depth');
    await settle();
    await transport.fail();
    mux.restart();
    await settle();
    expect(transport.streams).toHaveLength(2);
    expect(timers.waiting).toEqual([]);
  });

  it('begins anew when the server does not know the stream any more', async () => {
    const { transport, timers, watch } = setUp();
    const one = watch('a/depth');
    await settle();
    await transport.send({ streamId: 's1' });
    one.acknowledge(1n);
    await timers.run();
    await transport.failAck();
    expect(transport.streams[0]!.signal.aborted).toBe(true);
    await timers.run();
    expect(transport.streams).toHaveLength(2);
  });

  it('keeps items of an ended stream from the subscribers of the next', async () => {
    const { transport, mux, seen, watch } = setUp();
    watch('a/depth');
    await settle();
    await transport.send({ streamId: 's1' });
    const [old] = transport.streams;
    mux.restart();
    await settle();
    old!.push(create(StreamItemSchema, { subscriptionId: 1, seq: 3n }));
    await settle();
    expect(seen).toEqual([]);
  });
});
