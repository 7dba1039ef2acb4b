// What the page shows of a still scene is held against the scene's exact truth.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { assertNoFaults, Browser, logIn, until } from './support/browser.mjs';
import { shownPixels, waitForNextFrame } from './support/canvas.mjs';
import { stillSequence, writeScene } from './support/scene.mjs';
import { TestServer } from './support/server.mjs';

const [near_m, far_m] = [0.5, 2];

let server;
let browser;
let page;
let scene;
before(async () => {
  server = new TestServer();
  scene = writeScene(server.pictures);
  server.store('still', stillSequence(server.pictures, scene));
  await server.start();
  await server.setUp();
  browser = await Browser.launch();
  page = await browser.newPage({ viewport: { width: 1600, height: 900 } });
  await page.addInitScript(
    (display) => localStorage.setItem('visionserver.display', JSON.stringify(display)),
    { state: { colorMap: 'grey', fixedRange: { near_m, far_m }, showReasons: false }, version: 0 },
  );
  await logIn(page, server, 'admin', '/sequence/still');
  await waitForNextFrame(page);
});
after(async () => {
  await browser?.close();
  await server?.end();
});

/** The pixels that both cameras see, with their true depth, within the range of the colours. */
function* seenPixels() {
  for (let y = 0; y < scene.height; y += 2) {
    for (let x = 0; x < scene.width; x += 2) {
      const depth_m = scene.depth_m(x, y);
      if (depth_m > near_m && depth_m < far_m) yield { x, y, depth_m };
    }
  }
}

test('the grey of each pixel is the true disparity', async () => {
  const shown = await shownPixels(page);
  assert.deepEqual([shown.width, shown.height], [scene.width, scene.height]);
  // Colours are even in disparity: 0 is far_m, 255 is near_m.
  const disparity_px = (depth_m) => (scene.focal_px * scene.baseline_m) / depth_m - scene.offset_px;
  const [far_px, near_px] = [disparity_px(far_m), disparity_px(near_m)];
  let count = 0;
  let good = 0;
  for (const { x, y, depth_m } of seenPixels()) {
    const grey = shown.at(x, y);
    const measured_px = far_px + (grey / 255) * (near_px - far_px);
    ++count;
    // 1 px of matching, and half a step of grey.
    if (grey !== 0 && Math.abs(measured_px - disparity_px(depth_m)) < 1 + (near_px - far_px) / 510) ++good;
  }
  console.log(`${((100 * good) / count).toFixed(2)} % of ${count} pixels on the screen show the true disparity`);
  assert.ok(count > 50_000, `${count} pixels`);
  assert.ok(good / count > 0.97);
});

test('what the inspector reads is the truth within 2 %', async () => {
  const map = page.getByTestId('view-map');
  const box = await map.boundingBox();
  const { left, top, scale } = await map.evaluate(({ dataset }) => ({
    left: Number(dataset.left),
    top: Number(dataset.top),
    scale: Number(dataset.scale),
  }));
  const read = async (field) => {
    const text = await page.getByTestId(`inspector-${field}`).textContent();
    return Number.parseFloat(text);
  };
  // Away from edges, where a pixel more or less is another thing.
  const places = [...seenPixels()].filter(({ x, y, depth_m }) =>
    [-6, 6].every((step) =>
      [scene.depth_m(x + step, y), scene.depth_m(x, y + step)].every(
        (other_m) => Math.abs(other_m - depth_m) < 0.01 * depth_m,
      ),
    ),
  );
  for (const part of [0.1, 0.3, 0.5, 0.7, 0.9]) {
    const { x, y, depth_m } = places[Math.floor(part * places.length)];
    await page.mouse.move(box.x + left + (x + 0.5) * scale, box.y + top + (y + 0.5) * scale);
    await until('the inspector at the pixel', async () => (await read('x')) === x && (await read('y')) === y);
    const measured_m = await read('depth');
    console.log(`(${x}, ${y}): ${measured_m} m, true ${depth_m.toFixed(4)} m`);
    assert.ok(Math.abs(measured_m - depth_m) < 0.02 * depth_m);
    const X_m = ((x - scene.center_x_px) * depth_m) / scene.focal_px;
    const Y_m = ((y - scene.center_y_px) * depth_m) / scene.focal_px;
    assert.ok(Math.abs((await read('X')) - X_m) < 0.02 * Math.abs(X_m) + 0.001);
    assert.ok(Math.abs((await read('Y')) - Y_m) < 0.02 * Math.abs(Y_m) + 0.001);
  }
});

test('a slider changes the picture', async () => {
  const black = async () => {
    const shown = await shownPixels(page);
    let count = 0;
    for (const { x, y } of seenPixels()) if (shown.at(x, y) === 0) ++count;
    return count;
  };
  const before = await black();
  const slider = page.getByRole('slider', { name: /num_disparities/ });
  await slider.focus();
  await slider.press('Home'); // 1: too few for anything in this scene
  await until('a picture without depth', async () => (await black()) > 10 * before + 1000);
  const { values } = await server.admin.parameters.getParameters({
    sequence: 'still',
    paths: ['match.num_disparities'],
  });
  assert.equal(values[0].value.kind.value, 1n);
  assertNoFaults(page);
});
