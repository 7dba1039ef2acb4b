// soak.mjs [MINUTES]: shows 100,000 frames, or as many as the time allows (15 minutes), and fails if
// the heap of the page grows by more than 20 %. A browser draws 60 times a second at most, so that
// all of them take half an hour; the last line says how many there were.
import assert from 'node:assert/strict';

import { Browser, logIn } from './support/browser.mjs';
import { shownFrame, waitForNextFrame } from './support/canvas.mjs';
import { stillSequence, writeScene } from './support/scene.mjs';
import { TestServer } from './support/server.mjs';
import { sleep } from './support/watching.mjs';

const wantedFrames = 100_000;
const minutes = Number(process.argv[2] ?? 15);
const mostGrowth = 1.2;
// Compiled code, caches and pools are filled by then.
const warmUpFrames = 1000;

const server = new TestServer();
const scene = writeScene(server.pictures);
// A few disparities only: the sequence is to be quicker than the page.
server.store('fast', stillSequence(server.pictures, scene, { rate_hz: 200, match: { preset: 'single_pass', num_disparities: 16 } }));
await server.start();
await server.setUp();
const browser = await Browser.launch();
try {
  const page = await browser.newPage();
  await logIn(page, server, 'admin', '/sequence/fast');
  await waitForNextFrame(page);
  await page.getByTestId('view-map').evaluate((canvas) => {
    window.drawnCount = 0;
    new MutationObserver(() => ++window.drawnCount).observe(canvas, { attributeFilter: ['data-frame'] });
  });
  const drawnCount = () => page.evaluate(() => window.drawnCount);
  const devTools = await page.context().newCDPSession(page);
  const heapBytes = async () => {
    await devTools.send('HeapProfiler.collectGarbage');
    return (await devTools.send('Runtime.getHeapUsage')).usedSize;
  };
  const end = Date.now() + minutes * 60_000;
  while ((await drawnCount()) < warmUpFrames) await sleep(500);
  const first = await heapBytes();
  let largest = first;
  let drawn = await drawnCount();
  for (let next = 0; drawn < wantedFrames && Date.now() < end; await sleep(1000)) {
    drawn = await drawnCount();
    if (drawn < next) continue;
    largest = Math.max(largest, await heapBytes());
    next = drawn + wantedFrames / 20;
    console.log(`${drawn} frames drawn (number ${await shownFrame(page)}): heap at most ${(largest / 1e6).toFixed(1)} MB`);
  }
  const last = await heapBytes();
  console.log(
    `${drawn} frames: heap ${(first / 1e6).toFixed(1)} MB, at the end ${(last / 1e6).toFixed(1)} MB (${((last / first - 1) * 100).toFixed(1)} %)`,
  );
  assert.ok(last < mostGrowth * first, 'the heap of the page grows');
} finally {
  await browser.close();
  await server.end();
}
