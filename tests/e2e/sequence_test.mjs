// What one does on the page of a sequence: save, measure, look at the blocks. Held against
// the exact truth of a still scene and against what the server has.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { inflateSync } from 'node:zlib';

import { assertNoFaults, Browser, logIn, until } from './support/browser.mjs';
import { waitForNextFrame } from './support/canvas.mjs';
import { stillSequence, writeScene } from './support/scene.mjs';
import { TestServer } from './support/server.mjs';
import { countSubscribes, followSubscriptions } from './support/subscriptions.mjs';

let server;
let browser;
let page;
let watched;
let subscribes;
let scene;
let sequence;
before(async () => {
  server = new TestServer();
  scene = writeScene(server.pictures);
  sequence = stillSequence(server.pictures, scene);
  server.store('still', sequence);
  await server.start();
  await server.setUp();
  browser = await Browser.launch();
  page = await browser.newPage({ viewport: { width: 1600, height: 900 } });
  watched = followSubscriptions(page);
  subscribes = await countSubscribes(page);
  await logIn(page, server, 'admin', '/sequence/still');
  await waitForNextFrame(page);
});
after(async () => {
  await browser?.close();
  await server?.end();
});

/** Pixels on surfaces, away from edges, where a pixel more or less is another thing; spread evenly. */
function places(count) {
  const flat = [];
  for (let y = 8; y < scene.height - 8; y += 2) {
    for (let x = 8; x < scene.width - 8; x += 2) {
      const depth_m = scene.depth_m(x, y);
      const near = [[-6, 0], [6, 0], [0, -6], [0, 6]].map(([dx, dy]) => scene.depth_m(x + dx, y + dy));
      if (near.every((other_m) => Math.abs(other_m - depth_m) < 0.01 * depth_m)) flat.push({ x, y, depth_m });
    }
  }
  return Array.from({ length: count }, (_, i) => flat[Math.floor(((i + 0.5) / count) * flat.length)]);
}

/** What the menu's entry gives to download. */
async function save(entry) {
  await page.getByRole('button', { name: 'Save', exact: true }).click();
  const download = page.waitForEvent('download');
  await page.getByRole('menuitem', { name: entry }).click();
  return readFileSync(await (await download).path());
}

/** A 16-bit grey PNG without filters, as the page writes it. */
function decodePng16(file) {
  const data = [];
  let header;
  for (let at = 8; at < file.length; at += file.readUInt32BE(at) + 12) {
    const content = file.subarray(at + 8, at + 8 + file.readUInt32BE(at));
    const type = file.toString('latin1', at + 4, at + 8);
    if (type === 'IHDR') header = content;
    if (type === 'IDAT') data.push(content);
  }
  const [width, height] = [header.readUInt32BE(0), header.readUInt32BE(4)];
  assert.deepEqual([header[8], header[9]], [16, 0], 'bits, grey');
  const rows = inflateSync(Buffer.concat(data));
  const stride = 2 * width + 1;
  assert.equal(rows.length, height * stride);
  for (let y = 0; y < height; ++y) assert.equal(rows[y * stride], 0, 'the filter of a row');
  return { width, height, at: (x, y) => rows.readUInt16BE(y * stride + 1 + 2 * x) };
}

test('the saved depth is the truth within 2 %, in millimetres', async () => {
  const depth = decodePng16(await save(/^Depth/));
  assert.deepEqual([depth.width, depth.height], [scene.width, scene.height]);
  for (const { x, y, depth_m } of places(9)) {
    const saved_m = depth.at(x, y) / 1000;
    console.log(`(${x}, ${y}): ${saved_m} m, true ${depth_m.toFixed(4)} m`);
    assert.ok(Math.abs(saved_m - depth_m) < 0.02 * depth_m);
  }
});

test('the saved cloud holds as many points as its header says', async () => {
  const file = await save(/^Point cloud/);
  const end = 'end_header\n';
  const body = file.indexOf(end) + end.length;
  const header = file.toString('latin1', 0, body);
  const count = Number(header.match(/element vertex (\d+)/)[1]);
  assert.equal(header.match(/^property float [xyz]$/gm).length, 3);
  assert.equal(file.length - body, count * 12);
  assert.ok(count > 50_000, `${count} points`);
});

test('two clicks measure the true distance within 2 %', async () => {
  const map = page.getByTestId('view-map');
  const ends = [places(9)[2], places(9)[6]];
  await page.getByRole('button', { name: 'Measure', exact: true }).click();
  await page.getByTestId('distance').waitFor();
  const box = await map.boundingBox();
  const { left, top, scale } = await map.evaluate(({ dataset }) => ({ ...dataset }));
  for (const { x, y } of ends) {
    await page.mouse.click(box.x + Number(left) + (x + 0.5) * scale, box.y + Number(top) + (y + 0.5) * scale);
  }
  const [a, b] = ends.map(({ x, y, depth_m }) =>
    [(x - scene.center_x_px) / scene.focal_px, (y - scene.center_y_px) / scene.focal_px, 1].map((of) => of * depth_m),
  );
  const true_m = Math.hypot(...a.map((value, i) => value - b[i]));
  const measured_m = await until('a distance', async () =>
    Number.parseFloat(await page.getByTestId('distance').textContent()),
  );
  console.log(`${measured_m} m between the clicks, true ${true_m.toFixed(4)} m`);
  assert.ok(Math.abs(measured_m - true_m) < 0.02 * true_m);
});

test('the blocks show times and pictures, which end with their tab', async () => {
  const subscribers = async () =>
    (await server.admin.streams.listStreams({})).streams.find(({ stream }) => stream === 'still/depth').subscribers;
  const large = watched();
  assert.deepEqual(large, ['still/cameras.pair', 'still/depth']);
  await page.getByRole('tab', { name: 'Blocks' }).click();
  for (const output of ['cameras.pair', 'match.disparity']) {
    await until(`a picture of ${output}`, () => page.getByTestId(`preview-${output}`).getAttribute('data-frame'));
  }
  for (const { id } of sequence.blocks) {
    assert.match(await page.getByTestId(`time-${id}`).textContent(), /^\d+(\.\d+)? ms$/);
  }
  await until('the large depth to end', async () => (await subscribers()) === 1);
  assert.deepEqual(watched(), ['still/cameras.pair 160', 'still/depth 160']);
  await page.getByRole('tab', { name: 'Pictures' }).click();
  await waitForNextFrame(page);
  await until('the preview to end', async () => (await subscribers()) === 1);
  await until('all previews to end', () => watched().join() === large.join());
  // The server has obeyed each time.
  const { methods } = await server.admin.system.getStatistics({});
  for (const { method, failed } of methods.filter(({ method }) => /StreamService/.test(method))) {
    assert.equal(failed, 0n, method);
  }
});

test('a tab never has more than one Subscribe, whatever it shows', async () => {
  for (const [tab, view] of [
    ['Point cloud', 'view-cloud'],
    ['Blocks', 'preview-match.disparity'],
    ['Pictures', 'view-map'],
  ]) {
    await page.getByRole('tab', { name: tab }).click();
    await until(`a picture on the tab ${tab}`, () => page.getByTestId(view).getAttribute('data-frame'));
    assert.equal((await subscribes()).open, 1, tab);
  }
  // Away from what is live, and back.
  for (const place of ['Overview', 'Results']) {
    await page.getByRole('navigation').getByRole('link', { name: place }).click();
    await until(`no stream on the page ${place}`, async () => (await subscribes()).open === 0);
    await page.goBack();
    await until('a picture', () => page.getByTestId('view-map').getAttribute('data-frame'));
    assert.equal((await subscribes()).open, 1, place);
  }
  assert.equal((await subscribes()).mostAtOnce, 1);
  assertNoFaults(page);
});
