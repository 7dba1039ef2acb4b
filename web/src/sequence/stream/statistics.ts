const kWindowMs = 2000;
const kStaleAfterMs = 1000;

export interface Figures {
  /** Drawn per second, over the last two seconds; undefined until two were drawn or that time is over. */
  fps: number | undefined;
  /** From exposure to drawn, the middle one of the last two seconds; undefined when none was drawn. */
  latency_ms: number | undefined;
  /** Published by the sequence and not drawn, since the page was opened. */
  dropped: number;
  /** How long ago the newest was drawn; undefined before the first. */
  age_ms: number | undefined;
  /** Nothing new for a second. */
  stale: boolean;
}

interface Drawn {
  time_ms: number;
  latency_ms: number | undefined;
}

/** What a stream really delivered to the screen. Times are milliseconds of one monotonic clock. */
export class Statistics {
  private drawn: Drawn[] = [];
  private dropped = 0;
  private since_ms: number | undefined;
  private last_ms: number | undefined;

  onDropped(count: number): void {
    this.dropped += count;
  }

  /** `latency_ms` is undefined when the source does not say when it was captured. */
  onDrawn(now_ms: number, latency_ms: number | undefined): void {
    this.since_ms ??= now_ms;
    this.last_ms = now_ms;
    this.drawn.push({ time_ms: now_ms, latency_ms });
    this.forget(now_ms);
  }

  figures(now_ms: number): Figures {
    this.forget(now_ms);
    const age_ms = this.last_ms === undefined ? undefined : now_ms - this.last_ms;
    return {
      fps: this.fps(now_ms),
      latency_ms: this.latency(),
      dropped: this.dropped,
      age_ms,
      stale: age_ms !== undefined && age_ms > kStaleAfterMs,
    };
  }

  private fps(now_ms: number): number | undefined {
    if (this.since_ms === undefined) return undefined;
    const watched_ms = now_ms - this.since_ms;
    // Just begun: from the distances between the few that there are.
    if (watched_ms < kWindowMs) {
      return this.drawn.length > 1 && watched_ms > 0
        ? ((this.drawn.length - 1) * 1000) / watched_ms
        : undefined;
    }
    return (this.drawn.length * 1000) / kWindowMs;
  }

  private latency(): number | undefined {
    const sorted = this.drawn
      .flatMap(({ latency_ms }) => (latency_ms === undefined ? [] : [latency_ms]))
      .sort((a, b) => a - b);
    return sorted[Math.floor(sorted.length / 2)];
  }

  private forget(now_ms: number): void {
    const kept = this.drawn.findIndex(({ time_ms }) => now_ms - time_ms < kWindowMs);
    this.drawn.splice(0, kept < 0 ? this.drawn.length : kept);
  }
}
