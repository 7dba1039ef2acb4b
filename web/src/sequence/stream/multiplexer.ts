import { Backoff } from './backoff';
import type { AckItem, StreamItem, SubscriptionInit, Transport } from './transport';

/** What a subscriber asks for; the multiplexer chooses the id. */
export type Wanted = Omit<SubscriptionInit, 'id' | '$typeName'> & { stream: string };

export interface Subscriber {
  /** A picture, map or value. Answer with `acknowledge` once it is drawn or passed over. */
  onItem(item: StreamItem): void;
  /** Why nothing comes, in the server's words; empty when items come again. */
  onNotice(text: string): void;
}

export interface Subscribed {
  /** Asks for the same stream in another way (codec, rate, window). */
  change(wanted: Wanted): void;
  acknowledge(seq: bigint): void;
  end(): void;
}

export type Connection = 'closed' | 'connecting' | 'open' | 'waiting';

// From this window on the server has credit to go on with, so that acknowledgements can wait for each
// other. A call costs a browser more than the drawing of a picture does.
const kPatientWindow = 4;
const kPatienceMs = 50;

interface Entry {
  readonly subscriber: Subscriber;
  wanted: Wanted;
}

/** One opened Subscribe. */
interface Opened {
  readonly abort: AbortController;
  /** Empty until the server has named it. */
  id: string;
  /** What the server knows of. */
  readonly told: Map<number, Wanted>;
  updating: boolean;
  acking: boolean;
}

/** Times, so that tests need no clock. */
export interface Timers {
  /** Calls once after so many milliseconds; the answer cancels. */
  after(delay_ms: number, call: () => void): () => void;
}

export const browserTimers: Timers = {
  after: (delay_ms, call) => {
    const timer = setTimeout(call, delay_ms);
    return () => clearTimeout(timer);
  },
};

/**
 * All that one tab watches, over one Subscribe: browsers give a page six connections to a server,
 * so that a stream for each picture would soon leave none for calls.
 *
 * The stream is open only while somebody wants something and looks at it. When it breaks it
 * is opened again, with growing delays, and every subscription with it.
 */
export class Multiplexer {
  private readonly entries = new Map<number, Entry>();
  private readonly acks = new Map<number, bigint>();
  private readonly listeners = new Set<() => void>();
  private readonly backoff = new Backoff();
  private opened: Opened | undefined;
  private active = true;
  private nextId = 1;
  private reconciling = false;
  private flushing: { delay_ms: number; cancel: () => void } | undefined;
  private cancelRetry: (() => void) | undefined;
  private state: Connection = 'closed';

  constructor(
    private readonly transport: Transport,
    private readonly timers: Timers = browserTimers,
  ) {}

  get connection(): Connection {
    return this.state;
  }

  /** Told of each change of `connection`; the answer ends that. */
  readonly onConnection = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  subscribe(wanted: Wanted, subscriber: Subscriber): Subscribed {
    const id = this.nextId++;
    const entry: Entry = { subscriber, wanted };
    this.entries.set(id, entry);
    this.reconcileSoon();
    return {
      change: (other) => {
        entry.wanted = other;
        this.reconcileSoon();
      },
      acknowledge: (seq) => {
        if (!this.opened?.told.has(id)) return;
        this.acks.set(id, seq);
        this.flushWithin((entry.wanted.window ?? 0) >= kPatientWindow ? kPatienceMs : 0);
      },
      end: () => {
        this.entries.delete(id);
        this.acks.delete(id);
        this.reconcileSoon();
      },
    };
  }

  /** Whether anybody is there to see it: nothing is asked for while not. */
  setActive(active: boolean): void {
    this.active = active;
    this.reconcileSoon();
  }

  /** Opens the stream anew, at once: the server is back. */
  restart(): void {
    this.close();
    this.backoff.reset();
    this.reconcileSoon();
  }

  /** In one call for all that is drawn until then, an animation frame at least. */
  private flushWithin(delay_ms: number): void {
    if (this.flushing && this.flushing.delay_ms <= delay_ms) return;
    this.flushing?.cancel();
    const cancel = this.timers.after(delay_ms, () => {
      this.flushing = undefined;
      this.flush();
    });
    this.flushing = { delay_ms, cancel };
  }

  private flush(): void {
    const { opened } = this;
    if (!opened || opened.id === '' || opened.acking || this.acks.size === 0) return;
    const items: AckItem[] = [...this.acks].map(([subscriptionId, seq]) => ({
      subscriptionId,
      seq,
    }));
    this.acks.clear();
    opened.acking = true;
    this.transport.ack(opened.id, items).then(
      () => {
        opened.acking = false;
        this.flush();
      },
      () => this.broke(opened),
    );
  }

  /** Once for all changes that are made in one go. */
  private reconcileSoon(): void {
    if (this.reconciling) return;
    this.reconciling = true;
    queueMicrotask(() => {
      this.reconciling = false;
      this.reconcile();
    });
  }

  private reconcile(): void {
    if (!this.active || this.entries.size === 0) {
      this.close();
      return;
    }
    if (this.opened) void this.update(this.opened);
    else if (!this.cancelRetry) void this.open();
  }

  private async open(): Promise<void> {
    const opened: Opened = {
      abort: new AbortController(),
      id: '',
      told: new Map([...this.entries].map(([id, { wanted }]) => [id, wanted])),
      updating: false,
      acking: false,
    };
    this.opened = opened;
    this.setState('connecting');
    try {
      const wanted = [...opened.told].map(([id, one]) => ({ ...one, id }));
      for await (const item of this.transport.subscribe(wanted, opened.abort.signal)) {
        if (this.opened !== opened) return;
        if (item.streamId !== '') {
          opened.id = item.streamId;
          this.backoff.reset();
          this.setState('open');
          void this.update(opened);
        } else {
          this.deliver(item);
        }
      }
    } catch {
      // However it ended, it is opened again; what keeps it from that, the page shows elsewhere.
    }
    this.broke(opened);
  }

  private deliver(item: StreamItem): void {
    const entry = this.entries.get(item.subscriptionId);
    if (!entry) return;
    if (item.notice !== '') {
      entry.subscriber.onNotice(item.notice);
      return;
    }
    entry.subscriber.onItem(item);
  }

  /** Tells the server what has changed since it was told last. */
  private async update(opened: Opened): Promise<void> {
    if (opened.id === '' || opened.updating) return;
    opened.updating = true;
    for (;;) {
      const set = [...this.entries].filter(([id, entry]) => opened.told.get(id) !== entry.wanted);
      const remove = [...opened.told.keys()].filter((id) => !this.entries.has(id));
      if (set.length === 0 && remove.length === 0) break;
      for (const [id, entry] of set) opened.told.set(id, entry.wanted);
      for (const id of remove) opened.told.delete(id);
      try {
        await this.transport.update(
          opened.id,
          set.map(([id, { wanted }]) => ({ ...wanted, id })),
          remove,
        );
      } catch {
        this.broke(opened);
        return;
      }
    }
    opened.updating = false;
  }

  private broke(opened: Opened): void {
    if (this.opened !== opened) return;
    this.close();
    if (!this.active || this.entries.size === 0) return;
    this.setState('waiting');
    this.cancelRetry = this.timers.after(this.backoff.next_ms(), () => {
      this.cancelRetry = undefined;
      this.reconcile();
    });
  }

  private close(): void {
    this.cancelRetry?.();
    this.cancelRetry = undefined;
    const { opened } = this;
    this.opened = undefined;
    this.acks.clear();
    opened?.abort.abort();
    this.setState('closed');
  }

  private setState(state: Connection): void {
    if (this.state === state) return;
    this.state = state;
    for (const listener of this.listeners) listener();
  }
}
