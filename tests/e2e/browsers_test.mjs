// Three browsers at once, and one that draws slowly: each shows what is newest, never a queue of old
// pictures. Figures are printed, not judged: the machine may be busy.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { assertNoFaults, Browser, logIn, until } from './support/browser.mjs';
import { shownFrame, waitForNextFrame } from './support/canvas.mjs';
import { liveSequence } from './support/scene.mjs';
import { TestServer } from './support/server.mjs';
import { drawnFrames, latencies_ms, quantile, rate, sleep, watchCaptures, watchDrawing } from './support/watching.mjs';

const watched_ms = 5000;

let server;
let browser;
before(async () => {
  server = await new TestServer({
    live: liveSequence({ rate_hz: 30, match: { preset: 'single_pass' } }),
  }).start();
  await server.setUp();
  browser = await Browser.launch();
});
after(async () => {
  await browser?.close();
  await server?.end();
});

async function serverFrames() {
  const { frames } = await server.admin.sequences.getSequenceState({ id: 'live' });
  return Number(frames);
}

async function subscribers() {
  const { streams } = await server.admin.streams.listStreams({});
  return streams.find(({ stream }) => stream === 'live/depth').subscribers;
}

/** How many frames the screen is behind the sequence. */
async function framesBehind(page) {
  const shown = await shownFrame(page);
  return (await serverFrames()) - shown;
}

async function figures(page, captured) {
  const drawn = await drawnFrames(page);
  const latency_ms = latencies_ms(drawn, captured);
  return {
    drawn,
    text:
      `${rate(drawn).toFixed(1)} fps, capture to canvas p50 ${quantile(latency_ms, 0.5).toFixed(0)} ms,` +
      ` p95 ${quantile(latency_ms, 0.95).toFixed(0)} ms (${latency_ms.length} frames)`,
  };
}

test('three browsers show the newest frame, each for itself', async (three) => {
  // Programs of their own, as on three machines; in one they would share processes and connections.
  const browsers = [browser, await Browser.launch(), await Browser.launch()];
  const closeOthers = () => Promise.all(browsers.slice(1).map((one) => one.close()));
  three.after(closeOthers);
  const pages = await Promise.all(browsers.map((one) => one.newPage()));
  for (const page of pages) {
    await logIn(page, server, 'admin', '/sequence/live');
    await waitForNextFrame(page);
  }
  await Promise.all(pages.map(watchDrawing));
  const captures = watchCaptures(server, server.token, 'live/depth');
  const [cpu_s, framesBefore] = [server.cpuSeconds(), await serverFrames()];
  const began = performance.now();
  await sleep(watched_ms);
  const seconds = (performance.now() - began) / 1e3;
  const cpuPercent = (100 * (server.cpuSeconds() - cpu_s)) / seconds;
  const frames = (await serverFrames()) - framesBefore;
  const captured = await captures.end();
  console.log(`sequence: ${(frames / seconds).toFixed(1)} fps; server with matching: ${cpuPercent.toFixed(0)} % of a core`);

  for (const [i, page] of pages.entries()) {
    const { drawn, text } = await figures(page, captured);
    console.log(`browser ${i + 1}: ${text}`);
    for (let k = 1; k < drawn.length; ++k) assert.ok(drawn[k][0] > drawn[k - 1][0], 'never an older frame');
    await until('a page with the newest frames', async () => (await framesBehind(page)) <= 10);
    assertNoFaults(page);
  }
  await until('one subscription of each', async () => (await subscribers()) === 3);
  await pages[0].context().close();
  await closeOthers();
  await until('no subscription when all are closed', async () => (await subscribers()) === 0);
});

test('picture and map on the screen are of the same frame', async () => {
  const page = await browser.newPage();
  await logIn(page, server, 'admin', '/sequence/live');
  await waitForNextFrame(page);
  await page.getByTestId('view-map').evaluate((map) => {
    window.pairs = [];
    const picture = document.querySelector('[data-testid="view-picture"]');
    const note = () => window.pairs.push([map.dataset.frame, picture.dataset.frame]);
    new MutationObserver(note).observe(map, { attributeFilter: ['data-frame'] });
  });
  const pairs = await until('100 maps', async () => {
    const all = await page.evaluate(() => window.pairs);
    return all.length >= 100 && all;
  });
  const good = pairs.filter(([map, picture]) => map === picture).length;
  console.log(`${good} of ${pairs.length} maps on the screen with the picture of their frame`);
  // Streams may leave out different frames where the machine is busy.
  assert.ok(good > pairs.length / 2);
  await page.context().close();
});

test('a page that draws five times a second shows what is newest, and counts the rest', async () => {
  const page = await browser.newPage();
  await page.addInitScript(() => {
    window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 200);
    window.cancelAnimationFrame = (timer) => clearTimeout(timer);
  });
  await logIn(page, server, 'admin', '/sequence/live');
  await waitForNextFrame(page);
  await watchDrawing(page);
  const captures = watchCaptures(server, server.token, 'live/depth');
  const behind = [];
  for (const end = Date.now() + watched_ms; Date.now() < end; await sleep(200)) {
    behind.push(await framesBehind(page));
  }
  const { drawn, text } = await figures(page, await captures.end());
  const dropped = Number.parseInt((await page.getByTestId('dropped').textContent()).match(/\d+/)[0], 10);
  console.log(`slow page: ${text}, ${quantile(behind, 0.5)} frames behind (most ${Math.max(...behind)}), ${dropped} passed over`);
  // What is on the screen was newest when it was drawn, one drawing of 200 ms ago at most; a queue
  // would grow by 25 frames a second.
  assert.ok(quantile(behind, 0.5) <= 15, `${behind.join(' ')} frames behind`);
  const passed = drawn.at(-1)[0] - drawn[0][0] - (drawn.length - 1);
  assert.ok(passed > drawn.length, 'most frames are passed over');
  assert.ok(dropped >= passed, `${dropped} are counted, ${passed} were passed over while watched`);
  await page.context().close();
});

test('a hidden tab asks for nothing', async () => {
  const page = await browser.newPage();
  await logIn(page, server, 'admin', '/sequence/live');
  await waitForNextFrame(page);
  await page.evaluate(() => {
    Object.defineProperty(document, 'visibilityState', { value: 'hidden', configurable: true });
    Object.defineProperty(document, 'hidden', { value: true, configurable: true });
    document.dispatchEvent(new Event('visibilitychange', { bubbles: true }));
  });
  await until('no subscription', async () => (await subscribers()) === 0);
  await page.evaluate(() => {
    Object.defineProperty(document, 'visibilityState', { value: 'visible', configurable: true });
    Object.defineProperty(document, 'hidden', { value: false, configurable: true });
    document.dispatchEvent(new Event('visibilitychange', { bubbles: true }));
  });
  await waitForNextFrame(page);
  assert.equal(await subscribers(), 1);
  await page.context().close();
});
