// How old what is on the screen is, measured from outside: the page only says which frame it has just
// drawn; when that was captured is told by the server.
import { connect } from './api.mjs';

/** Begins to note when each frame was drawn, wall-clock ms. */
export async function watchDrawing(page) {
  await page.getByTestId('view-map').evaluate((canvas) => {
    window.drawn = [];
    const note = () =>
      window.drawn.push([Number(canvas.dataset.frame), performance.timeOrigin + performance.now()]);
    new MutationObserver(note).observe(canvas, { attributeFilter: ['data-frame'] });
  });
}

/** What was drawn since then, as [frame, wall-clock ms]; of a frame drawn twice the first time. */
export async function drawnFrames(page) {
  const drawn = await page.evaluate(() => window.drawn);
  return drawn.filter(([frame], i) => i === 0 || frame !== drawn[i - 1][0]);
}

/** Notes until `end` when frames were captured: frame to wall-clock ms, of five frames a second. */
export function watchCaptures(server, token, stream) {
  const captured = new Map();
  const { streams } = connect(server.page, token);
  const abort = new AbortController();
  const follow = async () => {
    const subscriptions = [{ id: 1, stream, maxFps: 5, maxWidthPx: 16 }];
    let streamId = '';
    for await (const item of streams.subscribe({ subscriptions }, { signal: abort.signal })) {
      streamId ||= item.streamId;
      if (!item.header) continue;
      const { captureTime, frameNumber } = item.header;
      captured.set(Number(frameNumber), Number(captureTime.seconds) * 1e3 + captureTime.nanos / 1e6);
      await streams.ack({ streamId, items: [{ subscriptionId: 1, seq: item.seq }] });
    }
  };
  const followed = follow().catch((error) => {
    if (!abort.signal.aborted) throw error;
  });
  return {
    end: async () => {
      abort.abort();
      await followed;
      return captured;
    },
  };
}

/** From capture to drawn, ms, of all frames of which both are known. */
export function latencies_ms(drawn, captured) {
  return drawn.flatMap(([frame, drawn_ms]) => {
    const captured_ms = captured.get(frame);
    return captured_ms === undefined ? [] : [drawn_ms - captured_ms];
  });
}

/** Of all values, the one below which `share` of them lie. */
export function quantile(values, share) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(Math.floor(share * sorted.length), sorted.length - 1)] ?? NaN;
}

/** Frames a second between the first and the last. */
export function rate(drawn) {
  const span_ms = drawn.at(-1)[1] - drawn[0][1];
  return ((drawn.length - 1) * 1e3) / span_ms;
}

export const sleep = (ms) => new Promise((done) => setTimeout(done, ms));
