import { create } from '@bufbuild/protobuf';
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { type StreamItem, StreamItemSchema } from '../../gen/visionserver/v1/stream_pb';
import type { Frame } from '../codec/frame';
import type { Subscriber, Wanted } from '../stream/multiplexer';
import { decoder, multiplexer } from '../stream/pageStreams';
import { settle } from '../stream/testing';
import { useDisplay } from './display';
import { LiveScene } from './liveScene';

const closed: bigint[] = [];
const wanted: Partial<Record<string, Wanted>> = {};
const subscribers: Partial<Record<string, Subscriber>> = {};
let scene: LiveScene;
let end: () => void;
/** "map picture" after each change of the map. */
let shown: string[];

beforeEach(() => {
  closed.length = 0;
  shown = [];
  useDisplay.setState({ showReasons: false });
  vi.spyOn(window, 'requestAnimationFrame').mockImplementation((draw) => {
    draw(0);
    return 0;
  });
  vi.spyOn(multiplexer, 'subscribe').mockImplementation((first, subscriber) => {
    wanted[first.stream] = first;
    subscribers[first.stream] = subscriber;
    return {
      acknowledge: () => undefined,
      change: (next) => (wanted[next.stream] = next),
      end: () => delete wanted[first.stream],
    };
  });
  vi.spyOn(decoder, 'decode').mockImplementation(({ subscriptionId, seq }: StreamItem) => {
    const base = { width: 1, height: 1, step: 1, frameNumber: seq };
    const frame =
      subscriptionId === 1
        ? { ...base, kind: 'disparity', stored: Uint16Array.of(16), scale: 1, offset: 0 }
        : { ...base, kind: 'picture', bitmap: { close: () => closed.push(seq) } };
    return Promise.resolve(frame as unknown as Frame);
  });
  scene = new LiveScene();
  scene.mapChanged.on(() => shown.push(`${scene.map!.frameNumber} ${scene.picture?.frameNumber}`));
  end = scene.watch({ map: 'cell/depth', picture: 'cell/left' });
});

afterEach(() => vi.useRealTimers());

async function receive(stream: 'depth' | 'left', seq: bigint) {
  const item = create(StreamItemSchema, {
    subscriptionId: stream === 'depth' ? 1 : 2,
    seq,
    header: { frameNumber: seq },
  });
  subscribers[`cell/${stream}`]!.onItem(item);
  await settle();
}

describe('LiveScene', () => {
  it('has the picture of each map, although pictures come first', async () => {
    await receive('left', 1n);
    await receive('depth', 1n);
    for (let frame = 2n; frame < 6n; ++frame) {
      await receive('left', frame);
      await receive('left', frame + 1n);
      await receive('depth', frame);
    }
    expect(shown).toEqual(['1 1', '2 2', '3 3', '4 4', '5 5']);
    end();
  });

  it('closes each picture once', async () => {
    for (const frame of [1n, 2n, 3n]) await receive('left', frame);
    await receive('depth', 3n);
    await receive('left', 4n);
    await receive('left', 5n);
    await receive('depth', 5n);
    await receive('left', 6n);
    end();
    expect(closed.sort()).toEqual([1n, 2n, 3n, 4n, 5n, 6n]);
  });

  it('asks for the reasons of invalid pixels only while somebody looks at them', () => {
    vi.useFakeTimers();
    const reasons = () => wanted['cell/depth']!.includeReasons;
    const later = () => vi.advanceTimersByTime(2000);
    const window = wanted['cell/depth']!.window;
    expect(reasons()).toBe(false);
    scene.hover({ x: 0, y: 0 });
    expect(reasons()).toBe(true);
    expect(wanted['cell/depth']!.window).toBe(window);
    scene.hover(undefined);
    // A pointer that goes from one view to the other.
    expect(reasons()).toBe(true);
    scene.hover({ x: 0, y: 0 });
    later();
    expect(reasons()).toBe(true);
    scene.hover(undefined);
    later();
    expect(reasons()).toBe(false);
    scene.pin({ x: 0, y: 0 });
    expect(reasons()).toBe(true);
    scene.pin(undefined);
    later();
    expect(reasons()).toBe(false);
    useDisplay.getState().set({ showReasons: true });
    expect(reasons()).toBe(true);
    useDisplay.getState().set({ showReasons: false });
    later();
    expect(reasons()).toBe(false);
    end();
  });

  it('asks for the reasons from the beginning when they are shown', () => {
    end();
    useDisplay.setState({ showReasons: true });
    end = scene.watch({ map: 'cell/depth', picture: 'cell/left' });
    expect(wanted['cell/depth']!.includeReasons).toBe(true);
    end();
  });

  it('asks for nothing after the end', () => {
    vi.useFakeTimers();
    scene.hover({ x: 0, y: 0 });
    scene.hover(undefined);
    end();
    scene.hover({ x: 0, y: 0 });
    vi.advanceTimersByTime(2000);
    expect(wanted).toEqual({});
  });
});
