// Real GigE Vision on the wire, from two simulated cameras to the overview: what it says of them while
// all is well, when their cable is pulled, and when they are back.
import './support/own_network.mjs';

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { assertNoFaults, Browser, logIn, picture, until } from './support/browser.mjs';
import { Cameras, pairSequence } from './support/cameras.mjs';
import { role, TestServer } from './support/server.mjs';

const cameras = new Cameras();
let server;
let browser;
let page;
before(async () => {
  // One packet in a thousand is lost on its way from the left camera.
  await cameras.plugIn('--fps', '10', '--fault', 'left drop 0.001');
  server = await new TestServer({ pair: pairSequence }).start();
  await server.setUp({ olga: role.operator });
  browser = await Browser.launch();
  page = await browser.newPage();
  await logIn(page, server);
});
after(async () => {
  await browser?.close();
  await server?.end();
  await cameras.pullCable();
});

/** The row of a camera, as { heading: text }. */
async function shown(serial) {
  const table = page.getByRole('region', { name: 'Cameras' });
  const headings = await table.getByRole('columnheader').allInnerTexts();
  const cells = await table.getByRole('row').filter({ hasText: serial }).getByRole('cell').allInnerTexts();
  return Object.fromEntries(headings.map((heading, i) => [heading, cells[i] ?? '']));
}
const number = (text) => Number(text.replaceAll(',', ''));
const [left, right] = ['21000001', '21000002'];

test('both cameras are shown with rate and counters', async () => {
  for (const serial of [left, right]) {
    await until(`camera ${serial} at 10 pictures a second`, async () => {
      const camera = await shown(serial);
      return camera.State === 'Streaming' && Math.abs(number(camera['Frames/s']) - 10) < 2;
    });
    const camera = await shown(serial);
    assert.match(camera.Camera, /^gev-ip:127\.0\.0\.[12]/);
    assert.match(camera.Camera, /Basler acA1300-30gm/);
    assert.ok(number(camera.Frames) > 0);
    for (const counter of ['Lost', 'Incomplete']) assert.match(camera[counter], /^\d[\d,]*$/);
    assert.equal(camera.Reconnects, '0');
    assert.equal(camera['Used by'], 'pair');
  }
  // What was lost on the wire was asked for, and came.
  await until('packets sent again', async () => {
    const [asked, came] = (await shown(left)).Resends.split(' / ').map(number);
    return asked > 0 && came > 0;
  });
});

test('the machine is shown, and who is online', async () => {
  const { diskTotalBytes } = await server.admin.system.getResources({});
  assert.ok(diskTotalBytes > 0n);
  const figure = (label) => page.locator('.vs-panel').filter({ has: page.getByText(label, { exact: true }) });
  await figure('Disk used').getByText(/^of [\d.]+\s[kMGT]?B; free [\d.]+\s[kMGT]?B$/).waitFor();
  await figure('Users online').getByText(/^admin, olga$/).waitFor();
  await page.getByText('Nothing needs attention.').waitFor();
  await picture(page, 'cameras');
  assertNoFaults(page);
});

test('a pulled cable is told in words and raises an alarm', async () => {
  await cameras.pullCable();
  for (const serial of [left, right]) {
    const { State } = await until(`camera ${serial} to be missed`, async () => {
      const camera = await shown(serial);
      return /^(Lost|Opening|Stalled)\s/.test(camera.State) && camera;
    });
    console.log(State);
  }
  const { alarms } = await until('an alarm', async () => {
    const listed = await server.admin.system.listAlarms({});
    return listed.alarms.length > 0 && listed;
  });
  for (const { id, message } of alarms) await page.getByText(`${id}: ${message}`).waitFor();
  await picture(page, 'cameras_pulled');
});

test('cameras that are back stream again by themselves', async () => {
  await cameras.plugIn('--fps', '10');
  for (const serial of [left, right]) {
    await until(`camera ${serial} to be back`, async () => {
      const camera = await shown(serial);
      return camera.State === 'Streaming' && number(camera.Reconnects) > 0 && number(camera['Frames/s']) > 5;
    });
  }
  await page.getByText('Nothing needs attention.').waitFor();
  await picture(page, 'cameras_back');
  assertNoFaults(page);
});
