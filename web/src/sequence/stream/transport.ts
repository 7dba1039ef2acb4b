import type { MessageInitShape } from '@bufbuild/protobuf';
import type {
  AcknowledgementSchema,
  StreamItem,
  SubscriptionSchema,
} from '../../gen/visionserver/v1/stream_pb';

export type { StreamItem };
// Plain objects, so that they can be spread.
type Plain<T> = T extends { $typeName: string } ? never : T;
export type SubscriptionInit = Plain<MessageInitShape<typeof SubscriptionSchema>>;
export type AckItem = Plain<MessageInitShape<typeof AcknowledgementSchema>>;

/** What the multiplexer needs of StreamService. */
export interface Transport {
  subscribe(wanted: SubscriptionInit[], signal: AbortSignal): AsyncIterable<StreamItem>;
  update(streamId: string, set: SubscriptionInit[], remove: number[]): Promise<unknown>;
  ack(streamId: string, items: AckItem[]): Promise<unknown>;
}
