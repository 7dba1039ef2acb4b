import type { Multiplexer, Subscribed, Wanted } from './multiplexer';
import type { StreamItem } from './transport';
import { type Figures, Statistics } from './statistics';

/** The page's clocks and its animation frames, so that tests need none. */
export interface Surroundings {
  /** Monotonic, milliseconds. */
  now_ms(): number;
  /** The server's monotonic clock, nanoseconds; undefined until it is known. */
  serverNow_ns(): bigint | undefined;
  /** Calls `draw` in the next animation frame. */
  nextFrame(draw: () => void): void;
}

export interface LiveOptions<T> {
  /** Without a window, it follows how quick the page is. */
  wanted: Wanted;
  decode(item: StreamItem): Promise<T>;
  draw(picture: T): void;
  /** Gives back what a picture holds that is not drawn. */
  release?(picture: T): void;
  /** Why nothing comes; empty once something comes. */
  onNotice?(text: string): void;
}

interface Waiting<T> {
  item: StreamItem;
  received_ms: number;
  picture: T;
}

// A page that needs this long from receipt to drawn is better off with one item under way: a second
// one would only grow old in the browser.
const SLOW_MS = 100;
const QUICK_MS = 50;
const QUICK_WINDOW = 2;

/**
 * One stream on the screen: takes items, decodes them, draws the newest in the next animation frame
 * and then acknowledges it. What is passed over on the way is acknowledged at once, and counted.
 */
export class LiveStream<T> {
  private readonly statistics = new Statistics();
  private readonly subscribed: Subscribed;
  private wanted: Wanted;
  private undecoded: { item: StreamItem; received_ms: number } | undefined;
  private decoding = false;
  private waiting: Waiting<T> | undefined;
  // Of the last few pictures, from receipt to drawn; undefined before the first.
  private turnaround_ms: number | undefined;
  private notice = '';
  private ended = false;

  constructor(
    mux: Pick<Multiplexer, 'subscribe'>,
    private readonly options: LiveOptions<T>,
    private readonly surroundings: Surroundings,
  ) {
    this.wanted = { window: QUICK_WINDOW, ...options.wanted };
    this.subscribed = mux.subscribe(this.wanted, {
      onItem: (item) => this.onItem(item),
      onNotice: (text) => this.setNotice(text),
    });
  }

  figures(): Figures {
    return this.statistics.figures(this.surroundings.now_ms());
  }

  end(): void {
    this.ended = true;
    this.subscribed.end();
    if (this.waiting) this.options.release?.(this.waiting.picture);
    this.waiting = undefined;
  }

  private onItem(item: StreamItem): void {
    this.setNotice('');
    this.statistics.onDropped(Number(item.dropped));
    if (this.undecoded) this.passOver(this.undecoded.item);
    this.undecoded = { item, received_ms: this.surroundings.now_ms() };
    if (!this.decoding) void this.decodeNewest();
  }

  private async decodeNewest(): Promise<void> {
    this.decoding = true;
    while (this.undecoded) {
      const { item, received_ms } = this.undecoded;
      this.undecoded = undefined;
      try {
        const picture = await this.options.decode(item);
        this.offer({ item, received_ms, picture });
      } catch (error) {
        this.passOver(item);
        this.setNotice(textOf(error));
      }
    }
    this.decoding = false;
  }

  private offer(next: Waiting<T>): void {
    if (this.ended) {
      this.options.release?.(next.picture);
      return;
    }
    if (this.waiting) {
      this.options.release?.(this.waiting.picture);
      this.passOver(this.waiting.item);
    } else {
      this.surroundings.nextFrame(() => this.drawNewest());
    }
    this.waiting = next;
  }

  private drawNewest(): void {
    const { waiting } = this;
    if (!waiting || this.ended) return;
    this.waiting = undefined;
    try {
      this.options.draw(waiting.picture);
    } catch (error) {
      // What is not acknowledged would hold its place in the window for ever.
      this.passOver(waiting.item);
      this.setNotice(textOf(error));
      return;
    }
    const now_ms = this.surroundings.now_ms();
    this.statistics.onDrawn(now_ms, this.latency_ms(waiting.item));
    this.subscribed.acknowledge(waiting.item.seq);
    this.adapt(now_ms - waiting.received_ms);
  }

  private latency_ms(item: StreamItem): number | undefined {
    const now_ns = this.surroundings.serverNow_ns();
    const capture_ns = item.header?.captureNs ?? 0n;
    if (now_ns === undefined || capture_ns === 0n) return undefined;
    return Number(now_ns - capture_ns) / 1e6;
  }

  private passOver(item: StreamItem): void {
    this.statistics.onDropped(1);
    this.subscribed.acknowledge(item.seq);
  }

  private adapt(turnaround_ms: number): void {
    if (this.options.wanted.window !== undefined) return;
    const before_ms = this.turnaround_ms ?? turnaround_ms;
    this.turnaround_ms = before_ms + 0.3 * (turnaround_ms - before_ms);
    const window =
      this.turnaround_ms > SLOW_MS ? 1
      : this.turnaround_ms < QUICK_MS ? QUICK_WINDOW
      : this.wanted.window;
    if (window === this.wanted.window) return;
    this.wanted = { ...this.wanted, window };
    this.subscribed.change(this.wanted);
  }

  private setNotice(text: string): void {
    if (this.notice === text) return;
    this.notice = text;
    this.options.onNotice?.(text);
  }
}

const textOf = (error: unknown) => (error instanceof Error ? error.message : String(error));
