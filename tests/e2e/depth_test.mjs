// What the page shows of a still scene is held against the scene's exact truth.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { assertNoFaults, Browser, logIn, picture, until } from './support/browser.mjs';
import { screenPixels, shownPixels, waitForNextFrame } from './support/canvas.mjs';
import { stillSequence, writeScene } from './support/scene.mjs';
import { TestServer } from './support/server.mjs';
import { followSubscriptions } from './support/subscriptions.mjs';

const [near_m, far_m] = [0.5, 2];

let server;
let browser;
let page;
let scene;
let subscriptions;
before(async () => {
  server = new TestServer();
  scene = writeScene(server.pictures);
  server.store('still', stillSequence(server.pictures, scene));
  await server.start();
  await server.setUp();
  browser = await Browser.launch();
  page = await browser.newPage({ viewport: { width: 1600, height: 900 } });
  subscriptions = followSubscriptions(page);
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

/** Where the map lies on its canvas: its upper left corner, and CSS pixels for one of it. */
const lie = (map) =>
  map.evaluate(({ dataset }) => ({
    left: Number(dataset.left),
    top: Number(dataset.top),
    scale: Number(dataset.scale),
  }));

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
  const { left, top, scale } = await lie(map);
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
    assert.ok(Math.abs((await read('Z')) - depth_m) < 0.02 * depth_m);
    // On the server's own machine the picture is not packed, so that its values are exact.
    assert.equal(await page.getByTestId('inspector-grey').textContent(), String(scene.grey(x, y)));
  }
});

test('invalid pixels have the colours of their reasons, which the legend explains', async () => {
  const watched = () => subscriptions(({ stream, includeReasons }) => `${stream} ${includeReasons}`);
  const away = () => page.mouse.move(1, 1);
  // With colours, so that those of the reasons, some of which are grey, are nowhere else.
  const colors = page.getByRole('combobox', { name: 'Colours', exact: true });
  await colors.selectOption('turbo');
  await away();
  await until('a map without reasons', () => watched().includes('still/depth false'));
  const map = page.getByTestId('view-map');
  const before = await screenPixels(page, map);

  const choice = page.getByRole('switch', { name: 'Reasons of invalid pixels' });
  await choice.click();
  const legend = page.getByTestId('reason-legend').getByRole('listitem');
  await legend.first().waitFor();
  assert.ok(watched().includes('still/depth true'));
  await waitForNextFrame(page);
  const entries = await legend.evaluateAll((items) =>
    items.map((item) => {
      const [, name, percent] = item.textContent.match(/^ ?(.*?) ([\d.]+)%$/);
      const color = getComputedStyle(item.querySelector('span')).backgroundColor.match(/\d+/g).map(Number);
      return { name, share: Number(percent) / 100, color };
    }),
  );
  console.log(entries.map(({ name, share }) => `${name} ${(100 * share).toFixed(1)} %`).join(', '));
  const shareOf = (pixels, [red, green, blue]) => {
    const all = pixels.all();
    return all.filter(([r, g, b]) => r === red && g === green && b === blue).length / all.length;
  };
  const after = await screenPixels(page, map);
  const [most] = entries;
  assert.ok(shareOf(before, most.color) < 0.001);
  // The view is larger than the picture, and pixels at edges are mixed.
  const seen = await lie(map);
  const ofView = (scene.width * scene.height * seen.scale ** 2) / (after.width * after.height);
  const shown = shareOf(after, most.color) / ofView;
  console.log(`${most.name}: ${(100 * shown).toFixed(1)} % of the map on the screen`);
  assert.ok(shown > 0.4 * most.share && shown < 1.1 * most.share);

  // The inspector has the reason also when the overlay is off.
  await choice.click();
  await legend.first().waitFor({ state: 'detached' });
  await away();
  await until('a map without reasons', () => watched().includes('still/depth false'));
  const isMost = (pixel) => pixel.every((value, c) => value === most.color[c]);
  const inside = after.all().findIndex((_, i) => {
    const [x, y] = [i % after.width, Math.floor(i / after.width)];
    if (x < 5 || y < 5 || x >= after.width - 5 || y >= after.height - 5) return false;
    return [[0, 0], [5, 0], [-5, 0], [0, 5], [0, -5]].every(([dx, dy]) => isMost(after.at(x + dx, y + dy)));
  });
  const x = Math.floor(((inside % after.width) - seen.left) / seen.scale);
  const y = Math.floor((Math.floor(inside / after.width) - seen.top) / seen.scale);
  // Without the legend the view is higher.
  const [box, now] = [await map.boundingBox(), await lie(map)];
  await page.mouse.move(box.x + now.left + (x + 0.5) * now.scale, box.y + now.top + (y + 0.5) * now.scale);
  const reason = page.getByTestId('inspector-reason');
  await until('the reason', async () => (await reason.textContent()) === most.name);
  assert.equal(await page.getByTestId('inspector-depth').textContent(), '–');
  await colors.selectOption('grey');
});

test('pictures that do not come any more are covered, and say for how long', async () => {
  const stale = page.getByText(/^No picture for \d+ s$/);
  assert.equal(await stale.count(), 0);
  const fresh = await screenPixels(page, page.getByTestId('view-picture'));
  await server.admin.sequences.stopSequence({ id: 'still' });
  await until('both views covered', async () => (await stale.count()) === 2);
  const seconds = async () => Number((await stale.first().textContent()).match(/\d+/)[0]);
  const first = await seconds();
  assert.ok(first >= 1, `${first} s`);
  await until('more seconds', async () => (await seconds()) > first);
  // It is seen: the picture beneath is darker.
  const covered = await screenPixels(page, page.getByTestId('view-picture'));
  const mean = (pixels) => pixels.all().reduce((sum, [red]) => sum + red, 0) / pixels.all().length;
  assert.ok(mean(covered) < 0.6 * mean(fresh), `${mean(covered)} after ${mean(fresh)}`);
  await picture(page, 'stale');
  await server.admin.sequences.startSequence({ id: 'still' });
  await until('pictures again', async () => (await stale.count()) === 0);
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
