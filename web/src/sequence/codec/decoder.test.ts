// @vitest-environment node
import { create, type MessageInitShape } from '@bufbuild/protobuf';
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { Codec, StreamItemSchema, StreamKind } from '../../gen/visionserver/v1/stream_pb';
import { LiveStream } from '../stream/liveStream';
import type { Subscriber } from '../stream/multiplexer';
import { settle } from '../stream/testing';
import { Decoder } from './decoder';
import type { Reply, Request } from './worker';

type Scope = {
  onmessage?: (event: { data: Request }) => void;
  postMessage(reply: Reply, options?: { transfer: Transferable[] }): void;
};

/** Runs worker.ts; what goes to and fro is copied or handed over, as between real threads. */
class LocalWorker {
  static readonly all: LocalWorker[] = [];
  static scope: Scope;
  terminated = false;
  onmessage: ((event: { data: Reply }) => void) | undefined;
  onerror: ((event: { message: string }) => void) | undefined;

  constructor() {
    LocalWorker.all.push(this);
  }

  postMessage(request: Request, transfer: Transferable[]): void {
    const data = structuredClone(request, { transfer });
    LocalWorker.scope.postMessage = (reply, options) => {
      const buffers = options?.transfer.filter((one) => one instanceof ArrayBuffer) ?? [];
      const answer = structuredClone(reply, { transfer: buffers });
      queueMicrotask(() => this.onmessage?.({ data: answer }));
    };
    LocalWorker.scope.onmessage!({ data });
  }

  terminate(): void {
    this.terminated = true;
  }
}

beforeEach(async () => {
  LocalWorker.all.length = 0;
  LocalWorker.scope = { postMessage: () => undefined };
  vi.stubGlobal('self', LocalWorker.scope);
  vi.stubGlobal('Worker', LocalWorker);
  vi.stubGlobal(
    'ImageData',
    class {
      constructor(
        readonly data: Uint8ClampedArray,
        readonly width: number,
        readonly height: number,
      ) {}
    },
  );
  // Of a browser: pictures of raw pixels, and of packed ones those that begin as JPEG does.
  vi.stubGlobal('createImageBitmap', async (source: Blob | { data: Uint8ClampedArray }) => {
    if (!(source instanceof Blob)) return { pixels: source.data };
    const bytes = new Uint8Array(await source.arrayBuffer());
    if (bytes[0] !== 0xff || bytes[1] !== 0xd8) {
      throw new DOMException('The source image could not be decoded.', 'InvalidStateError');
    }
    return { packed: bytes.length };
  });
  vi.resetModules();
  await import('./worker');
});
afterEach(() => {
  vi.unstubAllGlobals();
  vi.restoreAllMocks();
});

const geometry = { focalPx: 500, baselineM: 0.12, cxPx: 2, cyPx: 1 };
const hex = (text: string) => Uint8Array.from(Buffer.from(text, 'hex'));

type Header = NonNullable<MessageInitShape<typeof StreamItemSchema>['header']>;

const itemOf = (header: Header, payload: Uint8Array, reasons = new Uint8Array()) =>
  create(StreamItemSchema, { seq: header.frameNumber ?? 0n, header, payload, reasons });

/** The vector "the smallest and the largest value in turn" of tests/proto/wire/vectors/rvl.json. */
const packed = hex('ffcf1208f3ffbff30bf3ffcfff3cffffffff3bff00000030');
const values = [1, 65535, 1, 65535, 65535, 1, 65535, 1];
const mapHeader: Header = {
  kind: StreamKind.DISPARITY,
  codec: Codec.RVL,
  width: 4,
  height: 2,
  frameNumber: 7n,
  valueScale: 1 / 16,
  geometry,
};

describe('Decoder', () => {
  it('unpacks a map with its reasons, and leaves the item as it is', async () => {
    const item = itemOf({ ...mapHeader, codec: Codec.RAW }, hex('0100ffff0100ffffffff0100ffff0100'), hex('0001020304050607'));
    const frame = await new Decoder().decode(item);
    expect(frame).toMatchObject({ kind: 'disparity', width: 4, height: 2, step: 1, frameNumber: 7n, scale: 1 / 16 });
    if (frame.kind === 'picture') throw new Error('a picture');
    expect([...frame.stored]).toEqual(values);
    expect([...frame.reasons!]).toEqual([0, 1, 2, 3, 4, 5, 6, 7]);
    expect(item.payload).toHaveLength(16);
  });

  it('unpacks packed values, and knows no reasons where none were sent', async () => {
    const frame = await new Decoder().decode(itemOf({ ...mapHeader, kind: StreamKind.DEPTH }, packed));
    if (frame.kind === 'picture') throw new Error('a picture');
    expect(frame.kind).toBe('depth');
    expect([...frame.stored]).toEqual(values);
    expect(frame.reasons).toBeUndefined();
  });

  it('makes pictures of raw and of packed pixels, and knows which are exact', async () => {
    const decoder = new Decoder();
    const header = { kind: StreamKind.GREY_PICTURE, width: 2, height: 1, frameNumber: 8n };
    const raw = await decoder.decode(itemOf({ ...header, codec: Codec.RAW }, Uint8Array.of(9, 200)));
    const rgba = Uint8ClampedArray.of(9, 9, 9, 255, 200, 200, 200, 255);
    expect(raw).toMatchObject({ kind: 'picture', exact: true, bitmap: { pixels: rgba } });
    const jpeg = await decoder.decode(itemOf({ ...header, codec: Codec.JPEG }, hex('ffd8ffd9')));
    expect(jpeg).toMatchObject({ kind: 'picture', exact: false, bitmap: { packed: 4 } });
    expect(LocalWorker.all).toHaveLength(1);
  });

  it.each([
    ['cut packed values', itemOf(mapHeader, packed.slice(0, 8)), 'truncated'],
    ['too many packed values', itemOf({ ...mapHeader, width: 2 }, packed), 'bad run'],
    ['too few raw values', itemOf({ ...mapHeader, codec: Codec.RAW }, hex('0100')), 'raw pixels take 16 bytes, these are 2'],
    [
      'a picture that is none',
      itemOf({ ...mapHeader, kind: StreamKind.GREY_PICTURE, codec: Codec.JPEG }, hex('00112233')),
      'The source image could not be decoded.',
    ],
  ])('says which frame is spoilt, why, and what to do: %s', async (_, item, why) => {
    await expect(new Decoder().decode(item)).rejects.toThrow(
      `frame 7 cannot be unpacked: ${why}; if this stays, load the page again`,
    );
  });

  it('refuses items without pixels, and maps without geometry', async () => {
    const decoder = new Decoder();
    await expect(decoder.decode(create(StreamItemSchema, {}))).rejects.toThrow('values, not pictures');
    const item = itemOf({ ...mapHeader, geometry: undefined }, packed);
    await expect(decoder.decode(item)).rejects.toThrow('the map comes without its geometry');
  });

  it('begins a new worker after one has failed', async () => {
    const decoder = new Decoder();
    vi.spyOn(LocalWorker.prototype, 'postMessage').mockImplementationOnce(function (this: LocalWorker) {
      this.onerror!({ message: 'out of memory' });
    });
    await expect(decoder.decode(itemOf(mapHeader, packed))).rejects.toThrow('the decoder failed: out of memory');
    expect(LocalWorker.all[0]!.terminated).toBe(true);
    await expect(decoder.decode(itemOf(mapHeader, packed))).resolves.toMatchObject({ kind: 'disparity' });
  });
});

it('a stream goes on after a spoilt item, which it acknowledges and counts', async () => {
  let subscriber: Subscriber | undefined;
  const acknowledged: bigint[] = [];
  const drawn: bigint[] = [];
  const notices: string[] = [];
  const decoder = new Decoder();
  const live = new LiveStream(
    {
      subscribe: (_, given) => {
        subscriber = given;
        return { acknowledge: (seq) => acknowledged.push(seq), change: () => {}, end: () => {} };
      },
    },
    {
      wanted: { stream: 'cell/depth' },
      decode: (item) => decoder.decode(item),
      draw: ({ frameNumber }) => drawn.push(frameNumber),
      onNotice: (text) => notices.push(text),
    },
    { now_ms: () => 0, serverNow_ns: () => undefined, nextFrame: (draw) => draw() },
  );
  const receive = async (frameNumber: bigint, payload: Uint8Array) => {
    subscriber!.onItem(itemOf({ ...mapHeader, frameNumber }, payload));
    await settle();
  };
  await receive(1n, packed);
  await receive(2n, packed.slice(0, 8));
  expect(notices.at(-1)).toContain('frame 2 cannot be unpacked: truncated');
  await receive(3n, packed);
  expect(drawn).toEqual([1n, 3n]);
  expect(acknowledged).toEqual([1n, 2n, 3n]);
  expect(notices.at(-1)).toBe('');
  expect(live.figures().dropped).toBe(1);
});
