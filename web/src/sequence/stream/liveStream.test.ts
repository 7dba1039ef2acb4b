// @vitest-environment node
import { create } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { StreamItemSchema } from '../../gen/visionserver/v1/stream_pb';
import { LiveStream } from './liveStream';
import type { Subscriber, Wanted } from './multiplexer';
import { settle } from './testing';

/** A stream whose drawing takes as long, and goes as wrong, as the test says. */
function setUp(wanted: Wanted) {
  const page = {
    now_ms: 0,
    draw_ms: 0,
    age_ms: undefined as number | undefined,
    fault: '',
    drawn: [] as bigint[],
    acknowledged: [] as bigint[],
    windows: [] as (number | undefined)[],
    notices: [] as string[],
  };
  let handlers: Subscriber | undefined;
  let draw: (() => void) | undefined;
  const live = new LiveStream<bigint>(
    {
      subscribe: (first, given) => {
        page.windows.push(first.window);
        handlers = given;
        return {
          acknowledge: (seq) => page.acknowledged.push(seq),
          change: ({ window }) => page.windows.push(window),
          end: () => undefined,
        };
      },
    },
    {
      wanted,
      decode: ({ seq }) => Promise.resolve(seq),
      draw: (seq) => {
        page.now_ms += page.draw_ms;
        if (page.fault !== '') throw new Error(page.fault);
        page.drawn.push(seq);
      },
      onNotice: (text) => page.notices.push(text),
    },
    {
      now_ms: () => page.now_ms,
      serverNow_ns: () =>
        page.age_ms === undefined ? undefined : 1n + BigInt(page.age_ms) * 1_000_000n,
      nextFrame: (call) => (draw = call),
    },
  );
  const show = async (seq: bigint) => {
    handlers!.onItem(create(StreamItemSchema, { seq, header: { captureNs: 1n } }));
    await settle();
    draw!();
  };
  return { page, live, show };
}

describe('LiveStream', () => {
  it('acknowledges what could not be drawn, says why, and goes on', async () => {
    const { page, live, show } = setUp({ stream: 'cell/depth' });
    page.fault = 'the canvas is gone';
    await show(1n);
    expect(page.acknowledged).toEqual([1n]);
    expect(page.notices).toEqual(['the canvas is gone']);
    expect(live.figures().dropped).toBe(1);
    page.fault = '';
    await show(2n);
    expect(page.drawn).toEqual([2n]);
    expect(page.acknowledged).toEqual([1n, 2n]);
    expect(page.notices.at(-1)).toBe('');
  });

  it('leaves a window that it was given as it is', async () => {
    const { page, show } = setUp({ stream: 'cell/depth', window: 1 });
    for (let seq = 1n; seq <= 5n; ++seq) await show(seq);
    page.draw_ms = 500;
    for (let seq = 6n; seq <= 10n; ++seq) await show(seq);
    expect(page.windows).toEqual([1]);
  });

  it('has one item under way from the first slow picture on, and two on a quick page', async () => {
    const { page, show } = setUp({ stream: 'cell/depth' });
    page.draw_ms = 120;
    await show(1n);
    expect(page.windows).toEqual([2, 1]);
    page.draw_ms = 5;
    for (let seq = 2n; seq <= 10n; ++seq) await show(seq);
    expect(page.windows).toEqual([2, 1, 2]);
  });

  it('has as many under way as to gather acknowledgements, while what comes is fresh', async () => {
    const { page, show } = setUp({ stream: 'cell/depth' });
    page.draw_ms = 5;
    page.age_ms = 40;
    for (let seq = 1n; seq <= 3n; ++seq) await show(seq);
    expect(page.windows).toEqual([2, 5]);
    page.age_ms = 200;
    for (let seq = 4n; seq <= 20n; ++seq) await show(seq);
    expect(page.windows).toEqual([2, 5]);
    page.age_ms = 500;
    for (let seq = 21n; seq <= 30n; ++seq) await show(seq);
    expect(page.windows).toEqual([2, 5, 2]);
  });
});
