import { Track, type Waiting } from './framePairs';
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
  /** Where it waits for being drawn; without, the newest is drawn in the next animation frame. */
  track?: Pick<Track, 'offer' | 'clear'>;
  /** Gives back what a picture holds that is not drawn. */
  release?(picture: T): void;
  /** Why nothing comes; empty once something comes. */
  onNotice?(text: string): void;
}

interface Decoded<T> {
  item: StreamItem;
  decoding_ms: number;
  picture: T;
}

// A page that works this long on a picture is better off with one item under way: a second one would
// only grow old in the browser. Waiting for the animation frame is no work: meanwhile a newer one can
// take the place of the one that waits.
const kSlowMs = 100;
const kQuickMs = 50;
// What arrives so fresh came over a line that holds no queue; what arrives so old may have waited in
// one, which more items under way would make longer.
const kFreshMs = 150;
const kOldMs = 300;
const kWindow = 2;
// So many that all pictures are sent although acknowledgements are gathered.
const kGatheringWindow = 5;

/**
 * One stream on the screen: takes items, decodes them, draws the newest in the next animation frame,
 * or together with another stream's, and then acknowledges it. What waits longer is acknowledged
 * before; what is passed over on the way at once, and counted.
 */
export class LiveStream<T> {
  private readonly statistics = new Statistics();
  private readonly subscribed: Subscribed;
  private wanted: Wanted;
  private undecoded: { item: StreamItem; received_ms: number } | undefined;
  private decoding = false;
  private readonly track: Pick<Track, 'offer' | 'clear'>;
  // Of the last few pictures; undefined before the first.
  private work_ms: number | undefined;
  private latency_ms: number | undefined;
  private notice = '';
  private ended = false;

  constructor(
    mux: Pick<Multiplexer, 'subscribe'>,
    private readonly options: LiveOptions<T>,
    private readonly surroundings: Surroundings,
  ) {
    this.track = options.track ?? newestOnly(surroundings);
    this.wanted = { window: kWindow, ...options.wanted };
    this.subscribed = mux.subscribe(this.wanted, {
      onItem: (item) => this.onItem(item),
      onNotice: (text) => this.setNotice(text),
    });
  }

  figures(): Figures {
    return this.statistics.figures(this.surroundings.now_ms());
  }

  /** Asks for the same stream in another way; the window stays what it is. */
  change(wanted: Wanted): void {
    this.wanted = { window: this.wanted.window, ...wanted };
    this.subscribed.change(this.wanted);
  }

  end(): void {
    this.ended = true;
    this.subscribed.end();
    this.track.clear();
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
        this.offer({ item, decoding_ms: this.surroundings.now_ms() - received_ms, picture });
      } catch (error) {
        this.passOver(item);
        this.setNotice(textOf(error));
      }
    }
    this.decoding = false;
  }

  private offer(next: Decoded<T>): void {
    const { item, picture } = next;
    if (this.ended) {
      this.options.release?.(picture);
      return;
    }
    let acknowledged = false;
    const acknowledge = () => {
      if (!acknowledged) this.subscribed.acknowledge(item.seq);
      acknowledged = true;
    };
    this.track.offer({
      frameNumber: item.header?.frameNumber ?? 0n,
      draw: () => this.draw(next, acknowledge),
      keep: acknowledge,
      passOver: () => {
        this.options.release?.(picture);
        this.statistics.onDropped(1);
        acknowledge();
      },
    } satisfies Waiting);
  }

  private draw({ item, decoding_ms, picture }: Decoded<T>, acknowledge: () => void): void {
    const begin_ms = this.surroundings.now_ms();
    try {
      this.options.draw(picture);
    } catch (error) {
      // What is not acknowledged would hold its place in the window for ever.
      this.statistics.onDropped(1);
      acknowledge();
      this.setNotice(textOf(error));
      return;
    }
    const now_ms = this.surroundings.now_ms();
    const latency_ms = this.latencyOf(item);
    this.statistics.onDrawn(now_ms, latency_ms);
    acknowledge();
    this.adapt(decoding_ms + now_ms - begin_ms, latency_ms);
  }

  private latencyOf(item: StreamItem): number | undefined {
    const now_ns = this.surroundings.serverNow_ns();
    const capture_ns = item.header?.captureNs ?? 0n;
    if (now_ns === undefined || capture_ns === 0n) return undefined;
    return Number(now_ns - capture_ns) / 1e6;
  }

  private passOver(item: StreamItem): void {
    this.statistics.onDropped(1);
    this.subscribed.acknowledge(item.seq);
  }

  private adapt(work_ms: number, latency_ms: number | undefined): void {
    if (this.options.wanted.window !== undefined) return;
    this.work_ms = follow(this.work_ms, work_ms);
    this.latency_ms = latency_ms === undefined ? undefined : follow(this.latency_ms, latency_ms);
    const window = this.bestWindow(this.work_ms, this.latency_ms ?? kOldMs);
    if (window === this.wanted.window) return;
    this.wanted = { ...this.wanted, window };
    this.subscribed.change(this.wanted);
  }

  /** Between the limits it stays as it is. */
  private bestWindow(work_ms: number, latency_ms: number): number {
    const now = this.wanted.window ?? kWindow;
    if (work_ms > kSlowMs) return 1;
    if (work_ms > kQuickMs) return now;
    if (latency_ms < kFreshMs) return kGatheringWindow;
    return latency_ms < kOldMs ? Math.max(now, kWindow) : kWindow;
  }

  private setNotice(text: string): void {
    if (this.notice === text) return;
    this.notice = text;
    this.options.onNotice?.(text);
  }
}

/** Draws the newest in the next animation frame. */
function newestOnly(surroundings: Surroundings): Track {
  let asked = false;
  const track = new Track(1, () => {
    if (asked) return;
    asked = true;
    surroundings.nextFrame(() => {
      asked = false;
      if (track.newest !== undefined) track.showUpTo(track.newest);
    });
  });
  return track;
}

/** A mean of the last few values, the newest one counting most. */
const follow = (before: number | undefined, value: number) =>
  before === undefined ? value : before + 0.3 * (value - before);

const textOf = (error: unknown) => (error instanceof Error ? error.message : String(error));
