// What tests put in the place of the server.
import { create, type MessageInitShape } from '@bufbuild/protobuf';
import { type StreamItem, StreamItemSchema } from '../../gen/visionserver/v1/stream_pb';
import type { AckItem, SubscriptionInit, Transport } from './transport';

/** Lets all promises that can settle do so. */
export const settle = () => new Promise<void>((resolve) => setTimeout(resolve, 0));

/** One opened stream, as the server sees it. */
export class FakeStream implements AsyncIterable<StreamItem> {
  private readonly items: StreamItem[] = [];
  private failed = false;
  private wake: (() => void) | undefined;

  constructor(
    readonly wanted: SubscriptionInit[],
    readonly signal: AbortSignal,
  ) {}

  push(item: StreamItem): void {
    this.items.push(item);
    this.wake?.();
  }

  fail(): void {
    this.failed = true;
    this.wake?.();
  }

  async *[Symbol.asyncIterator](): AsyncGenerator<StreamItem> {
    for (;;) {
      const item = this.items.shift();
      if (item) {
        yield item;
      } else if (this.failed) {
        throw new Error('the server went');
      } else {
        await new Promise<void>((resolve) => {
          this.wake = resolve;
        });
      }
    }
  }
}

interface Call {
  resolve(): void;
  reject(error: Error): void;
}

/** Answers when the test says so. */
export class FakeTransport implements Transport {
  readonly streams: FakeStream[] = [];
  readonly updates: { streamId: string; set: SubscriptionInit[]; remove: number[] }[] = [];
  readonly acks: AckItem[][] = [];
  private readonly updateCalls: Call[] = [];
  private readonly ackCalls: Call[] = [];

  subscribe(wanted: SubscriptionInit[], signal: AbortSignal): FakeStream {
    const stream = new FakeStream(wanted, signal);
    this.streams.push(stream);
    return stream;
  }

  update(streamId: string, set: SubscriptionInit[], remove: number[]): Promise<void> {
    this.updates.push({ streamId, set, remove });
    return new Promise((resolve, reject) => this.updateCalls.push({ resolve, reject }));
  }

  ack(_streamId: string, items: AckItem[]): Promise<void> {
    this.acks.push(items);
    return new Promise((resolve, reject) => this.ackCalls.push({ resolve, reject }));
  }

  /** On the newest stream. */
  async send(item: MessageInitShape<typeof StreamItemSchema>): Promise<void> {
    this.streams.at(-1)!.push(create(StreamItemSchema, item));
    await settle();
  }

  async fail(): Promise<void> {
    this.streams.at(-1)!.fail();
    await settle();
  }

  async answerUpdate(): Promise<void> {
    this.updateCalls.shift()!.resolve();
    await settle();
  }

  async answerAck(): Promise<void> {
    this.ackCalls.shift()!.resolve();
    await settle();
  }

  async failAck(): Promise<void> {
    this.ackCalls.shift()!.reject(new Error('there is no such stream'));
    await settle();
  }
}
