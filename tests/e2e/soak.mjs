// soak.mjs [FRAMES]: shows 100,000 frames, or as many as it is told, as fast as the browser draws, on
// all tabs of the page; fails if its heap or its buffers grow by more than 20 %. Small frames: what
// grows does so with each frame, whatever its size. The size of the process is printed only: it holds
// what the test's own tool notes of each call that the page makes.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';

import { Browser, logIn } from './support/browser.mjs';
import { waitForNextFrame } from './support/canvas.mjs';
import { cheapSequence, writeScene } from './support/scene.mjs';
import { TestServer } from './support/server.mjs';
import { sleep } from './support/watching.mjs';

const wantedFrames = Number(process.argv[2] ?? 100_000);
const rounds = 10;
const mostGrowth = 1.2;

const server = new TestServer();
const scene = writeScene(server.pictures, 3);
server.store('fast', cheapSequence(server.pictures, scene, { rate_hz: 100, disparities: 32 }));
await server.start();
await server.setUp();
const browser = await Browser.launch(['--disable-frame-rate-limit', '--disable-gpu-vsync']);
try {
  const page = await browser.newPage();
  await logIn(page, server, 'admin', '/sequence/fast');
  await waitForNextFrame(page);
  // The frames of the map, on whichever tab.
  await page.evaluate(() => {
    window.drawnCount = 0;
    const ofMap = ({ target }) => ['view-map', 'view-cloud'].includes(target.dataset.testid);
    const count = (changes) => (window.drawnCount += changes.filter(ofMap).length);
    new MutationObserver(count).observe(document.body, { subtree: true, attributeFilter: ['data-frame'] });
  });
  const drawnCount = () => page.evaluate(() => window.drawnCount);
  const devTools = await page.context().newCDPSession(page);
  const memory = async () => {
    await devTools.send('HeapProfiler.collectGarbage');
    const { usedSize, backingStorageSize = 0 } = await devTools.send('Runtime.getHeapUsage');
    return { heap_mb: usedSize / 1e6, buffers_mb: backingStorageSize / 1e6, process_mb: await residentMb() };
  };
  const residentMb = async () => {
    const all = await browser.processes();
    const sizes = all
      .filter(({ type }) => type === 'renderer')
      .map(({ id }) => Number(readFileSync(`/proc/${id}/statm`, 'utf8').split(' ')[1]) * 4096);
    return Math.max(...sizes) / 1e6;
  };
  const until = async (frames) => {
    while ((await drawnCount()) < frames) await sleep(200);
  };
  const show = (tab) => page.getByRole('tab', { name: tab }).click();
  const print = (frames, { heap_mb, buffers_mb, process_mb }) =>
    console.log(
      `${String(frames).padStart(7)} frames: heap ${heap_mb.toFixed(1)} MB, buffers ${buffers_mb.toFixed(1)} MB,` +
        ` process ${process_mb.toFixed(0)} MB`,
    );

  // Compiled code and caches are there after the first round, with which the last one is compared.
  let first;
  let last;
  const begin = await drawnCount();
  for (let round = 1; round <= rounds; ++round) {
    for (const tab of ['Cloud', 'Blocks']) {
      await show(tab);
      await sleep(3000);
    }
    await show('Pictures');
    await until(begin + (round * wantedFrames) / rounds);
    last = await memory();
    first ??= last;
    print((await drawnCount()) - begin, last);
  }
  assert.ok(last.heap_mb < mostGrowth * first.heap_mb, 'the heap of the page grows');
  // Buffers wait for their collection; a few more frames of them are no growth.
  assert.ok(last.buffers_mb < mostGrowth * first.buffers_mb + 5, 'the buffers of the page grow');
} finally {
  await browser.close();
  await server.end();
}
