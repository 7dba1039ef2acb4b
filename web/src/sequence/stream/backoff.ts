const kShortestMs = 250;
const kLongestMs = 5000;

/** Delays between attempts: each twice the one before, up to 5 s, less a random part of up to half. */
export class Backoff {
  private delay_ms = kShortestMs;

  constructor(private readonly random: () => number = Math.random) {}

  next_ms(): number {
    const delay_ms = this.delay_ms;
    this.delay_ms = Math.min(2 * delay_ms, kLongestMs);
    // So that the pages of a whole factory do not come back in the same instant.
    return delay_ms * (1 - 0.5 * this.random());
  }

  reset(): void {
    this.delay_ms = kShortestMs;
  }
}
