// The point cloud of a still scene: what is drawn, what turns and colours it, what is measured in it,
// held against the scene's exact truth.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';

import { assertNoFaults, Browser, logIn, picture, until } from './support/browser.mjs';
import { screenPixels, waitForNextFrame } from './support/canvas.mjs';
import { stillSequence, writeScene } from './support/scene.mjs';
import { TestServer } from './support/server.mjs';

const [near_m, far_m] = [0.5, 2];
const background = [0x10, 0x11, 0x13];

let server;
let browser;
let page;
let scene;
let cloud;
let veil;
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
    { state: { colorMap: 'turbo', fixedRange: { near_m, far_m }, showReasons: false }, version: 0 },
  );
  await logIn(page, server, 'admin', '/sequence/still');
  await waitForNextFrame(page);
  await page.getByRole('tab', { name: 'Point cloud' }).click();
  cloud = page.getByTestId('view-cloud');
  // The other tab's views are veiled too, out of sight.
  veil = page.getByText(/^No picture for \d+ s$/).filter({ visible: true });
  await until('a cloud', () => cloud.getAttribute('data-frame'));
});
after(async () => {
  await browser?.close();
  await server?.end();
});

const same = (a, b) => a.every((value, i) => value === b[i]);

/** What the cloud looks like once it has been drawn again. */
async function look() {
  const frame = await cloud.getAttribute('data-frame');
  await until('the next cloud', async () => (await cloud.getAttribute('data-frame')) !== frame);
  let pixels;
  // Where the machine is so busy that the view grows old meanwhile, it is veiled.
  await until('a cloud that is not veiled', async () => {
    if ((await veil.count()) > 0) return false;
    pixels = (await screenPixels(page, cloud)).all();
    return (await veil.count()) === 0;
  });
  const drawn = pixels.filter((pixel) => !same(pixel, background));
  return { pixels, drawn, share: drawn.length / pixels.length };
}

/** The part of two views that differs. */
const difference = (a, b) => a.pixels.filter((pixel, i) => !same(pixel, b.pixels[i])).length / a.pixels.length;

const colors = {
  depth: 'Colour: depth',
  height: 'Colour: height (up in the picture)',
  picture: 'Colour: picture',
};
const choose = (what, label) => page.getByRole('combobox', { name: what }).selectOption({ label });
const setPointSize = (size) => page.getByRole('slider', { name: 'Size', exact: true }).fill(String(size));
const resetView = () => page.getByRole('button', { name: 'Reset view' }).click();

test('points are drawn; larger ones cover more; dragging turns them and a button turns them back', async () => {
  const first = await look();
  await picture(page, 'cloud');
  console.log(`${(100 * first.share).toFixed(1)} % of the view is covered`);
  assert.ok(first.share > 0.1);
  // A still scene and a still camera.
  assert.ok(difference(first, await look()) < 0.001);

  await setPointSize(6);
  const large = await look();
  console.log(`${(100 * large.share).toFixed(1)} % with large points`);
  assert.ok(large.share > 1.05 * first.share);
  await setPointSize(2);

  const box = await cloud.boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 150, y + 60, { steps: 5 });
  await page.mouse.up();
  const turned = await look();
  assert.ok(difference(first, turned) > 0.1, `${difference(first, turned)} has changed`);
  assert.ok(turned.share > 0.05);
  await resetView();
  assert.ok(difference(first, await look()) < 0.001);
});

test('colours by depth, height and picture differ, and those of the picture are grey', async () => {
  const isGrey = ([red, green, blue]) => red === green && green === blue;
  const views = {};
  for (const by of Object.keys(colors)) {
    await choose('What the colours are', colors[by]);
    views[by] = await look();
    // The axes have colours of their own.
    const grey = views[by].drawn.filter(isGrey).length / views[by].drawn.length;
    console.log(`by ${by}: ${(100 * grey).toFixed(1)} % grey`);
    if (by === 'picture') assert.ok(grey > 0.97);
    else assert.ok(grey < 0.05);
  }
  assert.ok(difference(views.depth, views.height) > 0.05);
  assert.ok(difference(views.depth, views.picture) > 0.05);
  assert.ok(difference(views.height, views.picture) > 0.05);
  // Which way heights go is said where they are chosen.
  const choice = page.getByRole('combobox', { name: 'What the colours are' });
  await choose('What the colours are', colors.height);
  assert.match(await choice.getAttribute('title'), /y axis of the left camera/);
  await choose('What the colours are', colors.depth);
});

test('the range of the colours is set beside the cloud, and the bar follows', async () => {
  const bar = page.getByRole('img', { name: /^Colours of the depths/ });
  const before = [await look(), await bar.getAttribute('aria-label')];
  const far = page.getByRole('textbox', { name: 'Farthest depth of the colours' });
  await far.fill('1.2');
  await far.press('Enter');
  await until('another bar', async () => (await bar.getAttribute('aria-label')) !== before[1]);
  assert.ok(difference(before[0], await look()) > 0.05);
  await far.fill(String(far_m));
  await far.press('Enter');
  // Heights have no metres of depth.
  await choose('What the colours are', colors.height);
  await bar.waitFor({ state: 'detached' });
  await choose('What the colours are', colors.depth);
  await bar.waitFor();
});

test('cloud and pictures are saved from here, all of the same frame', async () => {
  const files = [];
  page.on('download', (download) => files.push(download));
  await page.getByRole('button', { name: 'Save', exact: true }).click();
  await page.getByRole('menuitem', { name: 'All of these' }).click();
  await until('four files', () => files.length === 4);
  const names = files.map((file) => file.suggestedFilename()).sort();
  console.log(names.join(' '));
  const endings = names.map((name) => name.match(/^still_(\d+)_\d{8}T\d{6}\.\d{3}Z_(.*)$/));
  assert.deepEqual(endings.map(([, , ending]) => ending).sort(), [
    'cloud.ply',
    'depth_mm.png',
    'disparity_256.png',
    'picture.png',
  ]);
  assert.equal(new Set(endings.map(([, frame]) => frame)).size, 1, 'frames');
  const starts = { 'cloud.ply': 'ply', 'picture.png': '\x89PNG' };
  for (const file of files) {
    const start = starts[file.suggestedFilename().split('_').at(-1)];
    if (start) assert.ok(readFileSync(await file.path(), 'latin1').startsWith(start));
  }
});

/** Where points are seen with the view's reset, as the page places its camera: on the canvas, and how far away. */
function projection({ width, height }) {
  const z_m = (near_m + far_m) / 2;
  const eye = [0.45 * z_m, -0.5 * z_m, -0.25 * z_m];
  const minus = (a, b) => a.map((value, i) => value - b[i]);
  const dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a) => a.map((value) => value / Math.hypot(...a));
  const back = unit(minus(eye, [0, 0, z_m]));
  const right = unit(cross([0, -1, 0], back));
  const up = cross(back, right);
  const half = Math.tan(Math.PI / 8); // of 45 degrees
  return (point) => {
    const away = minus(point, eye);
    const depth = -dot(away, back);
    return {
      x: (dot(away, right) / (depth * half * (width / height)) + 1) * (width / 2),
      y: (1 - dot(away, up) / (depth * half)) * (height / 2),
      depth,
    };
  };
}

test('two clicks in the cloud measure the true distance within 3 %', async () => {
  await page.getByRole('button', { name: 'Measure', exact: true }).click();
  const distance = page.getByTestId('distance');
  await distance.waitFor();
  await resetView();
  const box = await cloud.boundingBox();
  const project = projection(box);
  const points = [];
  for (let y = 0; y < scene.height; y += 2) {
    for (let x = 0; x < scene.width; x += 2) {
      const depth_m = scene.depth_m(x, y);
      if (!(depth_m > near_m && depth_m < far_m)) continue;
      const point = [(x - scene.center_x_px) / scene.focal_px, (y - scene.center_y_px) / scene.focal_px, 1].map(
        (of) => of * depth_m,
      );
      points.push({ point, seen: project(point) });
    }
  }
  // Where only one surface is within reach of a click, and well inside the view.
  const clear = points.filter(({ seen }, i) => {
    if (i % 97 !== 0) return false;
    if (seen.x < 40 || seen.y < 40 || seen.x > box.width - 40 || seen.y > box.height - 40) return false;
    const near = points.filter((one) => Math.hypot(one.seen.x - seen.x, one.seen.y - seen.y) < 12);
    return near.length > 20 && near.every((one) => Math.abs(one.seen.depth - seen.depth) < 0.02 * seen.depth);
  });
  assert.ok(clear.length > 10, `${clear.length} places`);
  const [a, b] = [clear[0], clear.at(-1)];
  const true_m = Math.hypot(...a.point.map((value, i) => value - b.point[i]));
  assert.ok(true_m > 0.2, `${true_m} m`);

  for (const { point } of [a, b]) {
    // The words in the toolbar change, and with them perhaps the height that is left.
    const now = await cloud.boundingBox();
    const { x, y } = projection(now)(point);
    await page.mouse.click(now.x + x, now.y + y);
  }
  const measured_m = await until('a distance', async () => Number.parseFloat(await distance.textContent()));
  await picture(page, 'cloud_measured');
  console.log(`${measured_m} m between the clicks, true ${true_m.toFixed(4)} m`);
  assert.ok(Math.abs(measured_m - true_m) < 0.03 * true_m);
  assertNoFaults(page);
});
