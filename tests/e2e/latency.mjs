// latency.mjs [SECONDS]: the figures that the page must reach, measured and printed. For a quiet
// machine; judges nothing.
import { Browser, logIn } from './support/browser.mjs';
import { waitForNextFrame } from './support/canvas.mjs';
import { liveSequence } from './support/scene.mjs';
import { TestServer } from './support/server.mjs';
import { drawnFrames, latencies_ms, quantile, rate, sleep, watchCaptures, watchDrawing } from './support/watching.mjs';

const seconds = Number(process.argv[2] ?? 10);
const ms = (value) => `${value.toFixed(0)} ms`;

// The matching is made cheap: it is not what is measured.
const match = { preset: 'single_pass' };
const server = await new TestServer({ live: liveSequence({ rate_hz: 30, match }) }).start();
await server.setUp();
const browser = await Browser.launch();

async function cpuPercent() {
  const [used_s, began_ms] = [server.cpuSeconds(), performance.now()];
  await sleep(seconds * 1e3);
  return (100 * (server.cpuSeconds() - used_s)) / ((performance.now() - began_ms) / 1e3);
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
}

try {
  const alone = await cpuPercent();
  console.log(`server without browsers, with matching: ${alone.toFixed(1)} % of a core`);
  const opened = [];
  for (let i = 0; i < 3; ++i) opened.push(await openPage());
  const first = opened.map(({ firstPicture_ms }) => firstPicture_ms);
  console.log(`first picture after login: ${first.map(ms).join(', ')} (goal: 2000 ms)`);
  const watched = await cpuPercent();
  console.log(`three browsers cost the server ${(watched - alone).toFixed(1)} % of a core (goal: 15)`);
  console.log('three browsers (goal: p95 100 ms):');
  await report(opened.map(({ page }) => page));
  for (const { page } of opened) await page.context().close();

  const slow = await openPage({ drawEvery_ms: 200 });
  console.log('one browser that draws 5 times a second (goal: 300 ms behind):');
  await report([slow.page]);
} finally {
  await browser.close();
  await server.end();
}
