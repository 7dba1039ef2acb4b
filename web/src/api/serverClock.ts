import { api } from './clients';
import { sleep } from './wait';

// Quartz clocks part by less than 0.1 ms a second, and so by less than 6 ms in a minute.
const kPeriodMs = 60_000;
const kRetryMs = 2_000;
const kSamples = 3;

let offset_ns: bigint | undefined;

/** Nanoseconds of this page's monotonic clock. */
const pageNow_ns = () => BigInt(Math.round(performance.now() * 1e6));

/** One question: how far the server's clock is ahead, and how long the answer took. */
async function ask(signal: AbortSignal): Promise<{ offset_ns: bigint; roundTrip_ns: bigint }> {
  const before = pageNow_ns();
  const { monotonicNs } = await api.system.getServerInfo({}, { signal, timeoutMs: 5000 });
  const roundTrip_ns = pageNow_ns() - before;
  return { offset_ns: monotonicNs - before - roundTrip_ns / 2n, roundTrip_ns };
}

async function measure(stop: AbortSignal): Promise<void> {
  const samples = [];
  for (let i = 0; i < kSamples; ++i) samples.push(await ask(stop));
  // The quickest answer says the most.
  samples.sort((a, b) => Number(a.roundTrip_ns - b.roundTrip_ns));
  offset_ns = samples[0]!.offset_ns;
}

/**
 * Measures how far apart the clocks are, now and every minute until `stop` is aborted: while a stream
 * is open whose delay somebody sees. A server that was started again may have another clock.
 */
export async function followServerClock(stop: AbortSignal): Promise<void> {
  while (!stop.aborted) {
    const wait_ms = await measure(stop).then(
      () => kPeriodMs,
      () => kRetryMs,
    );
    await sleep(wait_ms, stop).catch(() => undefined);
  }
}

/**
 * The server's monotonic clock at this moment, nanoseconds, to within half of the quickest round
 * trip; undefined until the server has been asked.
 */
export function serverNowNs(): bigint | undefined {
  return offset_ns === undefined ? undefined : pageNow_ns() + offset_ns;
}
