import { api } from './clients';

// Quartz clocks part by less than 0.1 ms a second, and so by less than 6 ms in a minute.
const PERIOD_MS = 60_000;
const RETRY_MS = 2_000;
const SAMPLES = 3;

let offset_ns: bigint | undefined;
let timer: ReturnType<typeof setTimeout> | undefined;

/** Nanoseconds of this page's monotonic clock. */
const pageNow_ns = () => BigInt(Math.round(performance.now() * 1e6));

/** One question: how far the server's clock is ahead, and how long the answer took. */
async function ask(): Promise<{ offset_ns: bigint; roundTrip_ns: bigint }> {
  const before = pageNow_ns();
  const { monotonicNs } = await api.system.getServerInfo({}, { timeoutMs: 5000 });
  const roundTrip_ns = pageNow_ns() - before;
  return { offset_ns: monotonicNs - before - roundTrip_ns / 2n, roundTrip_ns };
}

/** Measures how far apart the clocks are, now and every minute. Call it after a reconnect. */
export async function measureServerClock(): Promise<void> {
  clearTimeout(timer);
  timer = setTimeout(() => void measureServerClock(), PERIOD_MS);
  try {
    const samples = [];
    for (let i = 0; i < SAMPLES; ++i) samples.push(await ask());
    // The quickest answer says the most.
    samples.sort((a, b) => Number(a.roundTrip_ns - b.roundTrip_ns));
    offset_ns = samples[0]!.offset_ns;
  } catch {
    clearTimeout(timer);
    timer = setTimeout(() => void measureServerClock(), RETRY_MS);
  }
}

/**
 * The server's monotonic clock at this moment, nanoseconds, to within half of the quickest round
 * trip; undefined until the server has been asked.
 */
export function serverNowNs(): bigint | undefined {
  return offset_ns === undefined ? undefined : pageNow_ns() + offset_ns;
}
