import { Codec, StreamKind, type StreamItem } from '../../gen/visionserver/v1/stream_pb';
import { baseOf, type Frame } from './frame';
import { DecodeError } from './rvl';
import type { Reply, Request } from './worker';

/** Turns items of a stream into frames, in one worker for the whole tab. */
export class Decoder {
  private readonly waiting = new Map<
    number,
    { resolve: (reply: Reply) => void; reject: (error: Error) => void }
  >();
  private worker: Worker | undefined;
  private nextId = 1;

  /** Rejects with DecodeError when the item holds no picture, or bytes that cannot be unpacked. */
  async decode(item: StreamItem): Promise<Frame> {
    const { header } = item;
    if (!header) throw new DecodeError('the stream holds values, not pictures');
    const base = baseOf(header);
    const request = requestOf(item, this.nextId++);
    const reply = await this.send(request);
    if (reply.kind === 'picture') {
      const { bitmap } = reply;
      return { ...base, kind: 'picture', bitmap, exact: header.codec === Codec.RAW };
    }
    if (reply.kind === 'error') {
      throw new DecodeError(
        `frame ${header.frameNumber} cannot be unpacked: ${reply.message}; if this stays, load the page again`,
      );
    }
    if (!header.geometry) throw new DecodeError('the map comes without its geometry');
    return {
      ...base,
      kind: header.kind === StreamKind.DISPARITY ? 'disparity' : 'depth',
      stored: reply.stored,
      reasons: reply.reasons,
      scale: header.valueScale,
      offset: header.valueOffset,
      geometry: header.geometry,
    };
  }

  private send(request: Request): Promise<Reply> {
    this.worker ??= this.start();
    const { worker } = this;
    return new Promise((resolve, reject) => {
      this.waiting.set(request.id, { resolve, reject });
      const transfer = [request.payload.buffer];
      if (request.kind === 'map' && request.reasons) transfer.push(request.reasons.buffer);
      worker.postMessage(request, transfer);
    });
  }

  private start(): Worker {
    const worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
    worker.onmessage = ({ data }: MessageEvent<Reply>) => {
      this.waiting.get(data.id)?.resolve(data);
      this.waiting.delete(data.id);
    };
    worker.onerror = (event) => {
      const error = new Error(`the decoder failed: ${event.message}`);
      for (const { reject } of this.waiting.values()) reject(error);
      this.waiting.clear();
      worker.terminate();
      this.worker = undefined;
    };
    return worker;
  }
}

function requestOf(item: StreamItem, id: number): Request {
  const { width, height, kind, codec } = item.header!;
  // Copied: what is handed to the worker is lost here, and the message is one buffer.
  const payload = item.payload.slice();
  if (kind === StreamKind.DISPARITY || kind === StreamKind.DEPTH) {
    return {
      id,
      kind: 'map',
      width,
      height,
      packing: codec === Codec.RAW ? 'raw' : 'rvl',
      payload,
      reasons:
        item.reasons.length > 0 ? (item.reasons.slice()) : undefined,
    };
  }
  if (kind === StreamKind.GREY_PICTURE || kind === StreamKind.COLOUR_PICTURE) {
    return {
      id,
      kind: 'picture',
      width,
      height,
      packing: codec === Codec.RAW ? 'raw' : 'jpeg',
      payload,
    };
  }
  throw new DecodeError('the stream holds values, not pictures');
}
