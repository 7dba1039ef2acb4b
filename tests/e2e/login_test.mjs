// The first minutes with a new server: the one-time password, one's own, and the first picture.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { connect } from './support/api.mjs';
import { assertNoFaults, Browser, fillLogin, logIn, picture, until, userField } from './support/browser.mjs';
import { liveSequence } from './support/scene.mjs';
import { adminPassword, TestServer } from './support/server.mjs';

const maxInitialBytes = 300_000;

let server;
let browser;
before(async () => {
  server = await new TestServer({ live: liveSequence() }).start();
  browser = await Browser.launch();
});
after(async () => {
  await browser?.close();
  await server?.end();
});

test('the first login asks for a password of one\'s own', async () => {
  const page = await browser.newPage();
  await page.goto(server.page);
  await userField(page).waitFor();
  await picture(page, 'login');

  await fillLogin(page, 'admin', 'a wrong guess');
  await page.getByRole('alert').waitFor();
  assert.equal(await page.getByRole('navigation').count(), 0);

  page.faults.length = 0; // the browser tells of the refused call
  await fillLogin(page, 'admin', server.oneTimePassword);
  await page.getByLabel(/^New password( \*)?$/).fill(adminPassword);
  await page.getByLabel(/^New password again/).fill(adminPassword);
  await page.getByRole('button', { name: 'Change password' }).click();
  await page.getByRole('navigation').waitFor();
  assertNoFaults(page);
});

test('the first picture needs little to be loaded', async () => {
  const page = await browser.newPage();
  const loaded = [];
  page.on('response', (response) => {
    const { pathname } = new URL(response.url());
    if (pathname.startsWith('/visionserver.')) return; // a call
    const size = async () => (await response.request().sizes()).responseBodySize;
    loaded.push(size().then((bytes) => [pathname, bytes]));
  });
  await logIn(page, server, 'admin', '/sequence/live');
  const loggedIn = performance.now();
  const map = page.getByTestId('view-map');
  await until('a first picture', () => map.getAttribute('data-frame', { timeout: 0 }));
  const first_ms = performance.now() - loggedIn;
  const files = await Promise.all(loaded);
  const bytes = files.reduce((sum, [, size]) => sum + size, 0);
  console.log(`first picture ${first_ms.toFixed(0)} ms after login (goal: 2000)`);
  console.log(`loaded before it: ${files.length} files, ${bytes} bytes as the server sends them (at most ${maxInitialBytes})`);
  assert.ok(bytes <= maxInitialBytes, files.map((file) => file.join(' ')).join('\n'));
  assertNoFaults(page);
});

test('who logs out is asked again, and the old token is worth nothing', async () => {
  const page = await browser.newPage();
  await logIn(page, server);
  const { token } = await page.evaluate(() => JSON.parse(sessionStorage.getItem('visionserver.session')));
  const { user } = await connect(server.page, token).sessions.whoAmI({});
  assert.equal(user, 'admin');
  await page.getByRole('button', { name: 'admin' }).click();
  await page.getByRole('menuitem', { name: 'Log out' }).click();
  await userField(page).waitFor();
  await assert.rejects(connect(server.page, token).sessions.whoAmI({}), /unauthenticated/);
});
