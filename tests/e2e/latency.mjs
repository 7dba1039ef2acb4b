// latency.mjs [SECONDS]: the figures that the page must reach, measured and printed. For a quiet
// machine; judges nothing.
import { Browser, logIn } from './support/browser.mjs';
import { waitForNextFrame } from './support/canvas.mjs';
import { cheapSequence, writeScene } from './support/scene.mjs';
import { TestServer } from './support/server.mjs';
import { drawnFrames, latencies_ms, quantile, rate, sleep, watchCaptures, watchDrawing } from './support/watching.mjs';

const seconds = Number(process.argv[2] ?? 10);
const rate_hz = 30;
// Browsers translate the page's code into quick code while it runs.
const warmUpMs = 500 * seconds;
const ms = (value) => `${value.toFixed(0)} ms`;

const server = new TestServer();
const scene = writeScene(server.pictures);
server.store('live', cheapSequence(server.pictures, scene, { rate_hz }));
await server.start();
await server.setUp();
const browser = await Browser.launch();

/** Of the server: parts of a core, frames it ran, and processor time of each, ms. */
async function serverLoad() {
  const frames = async () => Number((await server.admin.sequences.getSequenceState({ id: 'live' })).frames);
  const before = { cpu_s: server.cpuSeconds(), frames: await frames(), now_ms: performance.now() };
  await sleep(seconds * 1e3);
  const cpu_ms = (server.cpuSeconds() - before.cpu_s) * 1e3;
  const span_ms = performance.now() - before.now_ms;
  const ran = (await frames()) - before.frames;
  return { percent: (100 * cpu_ms) / span_ms, fps: (1e3 * ran) / span_ms, frame_ms: cpu_ms / ran };
}

async function openPage(options = {}) {
  const page = await browser.newPage();
  if (options.drawEvery_ms) {
    await page.addInitScript((every_ms) => {
      window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), every_ms);
    }, options.drawEvery_ms);
  }
  await logIn(page, server, 'admin', '/sequence/live');
  const loggedIn_ms = performance.now();
  await waitForNextFrame(page);
  const firstPicture_ms = performance.now() - loggedIn_ms;
  return { page, firstPicture_ms };
}

async function report(pages) {
  await sleep(warmUpMs);
  await Promise.all(pages.map(watchDrawing));
  const captures = watchCaptures(server, server.token, 'live/depth');
  await sleep(seconds * 1e3);
  const captured = await captures.end();
  for (const page of pages) {
    const drawn = await drawnFrames(page);
    const latency_ms = latencies_ms(drawn, captured);
    console.log(
      `  ${rate(drawn).toFixed(1)} fps, capture to canvas p50 ${ms(quantile(latency_ms, 0.5))},` +
        ` p95 ${ms(quantile(latency_ms, 0.95))} of ${latency_ms.length}`,
    );
  }
  const { latencyP50Us } = await server.admin.sequences.getSequenceState({ id: 'live' });
  console.log(`  of that until the server has matched it: p50 ${ms(latencyP50Us / 1e3)}`);
}

try {
  const alone = await serverLoad();
  console.log(
    `the server without browsers: ${alone.percent.toFixed(0)} % of a core for ${alone.fps.toFixed(1)} frames/s` +
      ` (${alone.frame_ms.toFixed(1)} ms each, nearly all of it matching)`,
  );

  const first = await openPage();
  console.log(`one browser: first picture ${ms(first.firstPicture_ms)} after login (goal: 2000 ms)`);
  await report([first.page]);

  const opened = [first, await openPage(), await openPage()];
  const firstPictures = opened.slice(1).map(({ firstPicture_ms }) => ms(firstPicture_ms));
  console.log(`three browsers: first picture of the others ${firstPictures.join(', ')}; goal: 30 fps, p95 100 ms`);
  await report(opened.map(({ page }) => page));
  const watched = await serverLoad();
  const cost_ms = watched.frame_ms - alone.frame_ms;
  console.log(
    `they cost the server ${cost_ms.toFixed(1)} ms a frame: ${((cost_ms * rate_hz) / 10).toFixed(1)} %` +
      ` of a core at ${rate_hz} frames/s (goal: 15)`,
  );
  for (const { page } of opened) await page.context().close();

  const slow = await openPage({ drawEvery_ms: 200 });
  console.log('one browser that draws 5 times a second (goal: 300 ms behind):');
  await report([slow.page]);
} finally {
  await browser.close();
  await server.end();
}
