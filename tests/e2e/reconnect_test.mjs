// The page outlives the server, and the session.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { Browser, logIn } from './support/browser.mjs';
import { waitForNextFrame } from './support/canvas.mjs';
import { liveSequence } from './support/scene.mjs';
import { passwordOf, role, TestServer } from './support/server.mjs';

let server;
let browser;
before(async () => {
  server = await new TestServer({ live: liveSequence() }).start();
  await server.setUp({ emil: role.engineer });
  browser = await Browser.launch();
});
after(async () => {
  await browser?.close();
  await server?.end();
});

const find = (page) => page.getByLabel('Find a parameter');
/** What a page keeps for which nobody has pressed a button yet. */
const typed = 'disparities';

test('a page goes on by itself when its server was restarted', async () => {
  const page = await browser.newPage();
  await logIn(page, server, 'emil', '/sequence/live');
  await waitForNextFrame(page);
  await find(page).fill(typed);
  const document = await page.evaluate(() => (window.sameDocument = true));

  await server.kill();
  await page.getByText('Connection to the server lost').waitFor();
  await server.start();
  await page.getByText('Connection to the server lost').waitFor({ state: 'hidden' });
  // A new run of the sequence counts its frames from 1.
  await waitForNextFrame(page, { startedAnew: true });
  assert.equal(await find(page).inputValue(), typed);
  assert.equal(await page.evaluate(() => window.sameDocument), document);
  await page.context().close();
});

async function endSessions() {
  const { sessions } = await server.admin.users.listSessions({ user: 'emil' });
  for (const { id } of sessions) await server.admin.sessions.revokeSession({ sessionId: id });
}

const loginDialog = (page) => page.getByRole('dialog', { name: 'Log in again' });

async function logInAgain(page) {
  const dialog = loginDialog(page);
  await dialog.getByLabel(/^Password/).fill(passwordOf('emil'));
  await dialog.getByRole('button', { name: 'Log in', exact: true }).click();
  await dialog.waitFor({ state: 'hidden' });
}

test('a session that an administrator ends is taken up again over the page', async () => {
  const page = await browser.newPage();
  await logIn(page, server, 'emil', '/sequence/live');
  await waitForNextFrame(page);
  await find(page).fill(typed);

  await endSessions();
  await loginDialog(page).waitFor();
  assert.equal(await page.getByRole('navigation').count(), 1, 'the page is still there');

  await logInAgain(page);
  await waitForNextFrame(page);
  assert.equal(await find(page).inputValue(), typed);
  await page.context().close();
});

test('a session that ends is noticed although only the stream of pictures is open', async () => {
  const page = await browser.newPage();
  await logIn(page, server, 'emil', '/sequence/live');
  await waitForNextFrame(page);
  // No other call is answered, so that none can tell.
  const held = [];
  const others = /visionserver\.v1\.\w+\/(?!Subscribe$)/;
  await page.route(others, (route) => held.push(route));
  await endSessions();
  await loginDialog(page).waitFor();
  await page.unroute(others);
  await logInAgain(page);
  for (const route of held) await route.abort().catch(() => {}); // perhaps given up meanwhile
  await waitForNextFrame(page);
  await page.context().close();
});
