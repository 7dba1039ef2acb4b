// Users and audit, as an administrator sees them.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { connect } from './support/api.mjs';
import { assertNoFaults, Browser, logIn, until } from './support/browser.mjs';
import { passwordOf, role, TestServer } from './support/server.mjs';
import { sleep } from './support/watching.mjs';

let server;
let browser;
before(async () => {
  server = await new TestServer().start();
  await server.setUp({ olga: role.operator, emil: role.engineer });
  browser = await Browser.launch();
});
after(async () => {
  await browser?.close();
  await server?.end();
});

/** The row of a table that holds all these texts. */
const rowWith = (page, ...texts) =>
  texts.reduce((found, hasText) => found.filter({ hasText }), page.getByRole('row')).first();

async function openAudit(page) {
  await page.getByRole('link', { name: 'Audit' }).click();
  await page.getByRole('heading', { name: 'Audit' }).waitFor();
}

test('a user is created, disabled and seen in the audit', async () => {
  const page = await browser.newPage();
  await logIn(page, server, 'admin', '/users');
  await page.getByRole('button', { name: 'New user' }).click();
  const dialog = page.getByRole('dialog');
  await dialog.getByRole('textbox', { name: 'Name', exact: true }).fill('vera');
  await dialog.getByRole('button', { name: 'Create' }).click();
  await page.getByText('One-time password of vera').waitFor();
  await page.getByRole('button', { name: 'Done' }).click();

  const anybody = connect(server.page);
  const olga = { user: 'olga', password: passwordOf('olga') };
  await anybody.sessions.login(olga);
  await page.getByRole('button', { name: 'Actions for olga' }).click();
  await page.getByRole('menuitem', { name: 'Disable' }).click();
  await page.getByRole('row').filter({ hasText: 'olga' }).filter({ hasText: 'Disabled' }).waitFor();
  await assert.rejects(anybody.sessions.login(olga), /unauthenticated|permission_denied/);
  assertNoFaults(page);

  await openAudit(page);
  await rowWith(page, 'admin', 'CreateUser', 'vera').waitFor();
  await rowWith(page, 'admin', 'UpdateUser', 'olga').waitFor();
  // The refused login, with the reason.
  await rowWith(page, 'Login', 'olga').waitFor();
  await page.getByRole('textbox', { name: 'Call' }).fill('CreateUser');
  await until('only those entries', async () => (await page.getByRole('row', { name: 'Login' }).count()) === 0);
  assert.ok((await page.getByRole('row', { name: 'CreateUser' }).count()) >= 2);
  await page.context().close();
});

test('a user whose guesses locked the account is unlocked', async () => {
  const login = (password) => connect(server.page).sessions.login({ user: 'emil', password });
  const page = await browser.newPage();
  await logIn(page, server, 'admin', '/users');
  // The first locks end after seconds: somebody goes on guessing until the administrator acts.
  let guesses = true;
  const guessing = (async () => {
    for (; guesses; await sleep(300)) await assert.rejects(login('a wrong guess'));
  })();
  await rowWith(page, 'emil', 'Locked until').waitFor();
  await page.getByRole('button', { name: 'Actions for emil' }).click();
  await page.getByRole('menuitem', { name: 'Unlock' }).click();
  guesses = false;
  await guessing;
  await rowWith(page, 'emil', 'Active').waitFor();
  await login(passwordOf('emil'));
  await openAudit(page);
  await rowWith(page, 'admin', 'UnlockUser', 'emil').waitFor();
  assertNoFaults(page);
  await page.context().close();
});

test('a role that is chosen in the table counts at once', async () => {
  const { token } = await connect(server.page).sessions.login({ user: 'emil', password: passwordOf('emil') });
  const page = await browser.newPage();
  await logIn(page, server, 'admin', '/users');
  await page.getByRole('combobox', { name: 'Role of emil' }).selectOption('Viewer');
  await until('the new role', async () => (await connect(server.page, token).sessions.whoAmI({})).role === role.viewer);
  await openAudit(page);
  await rowWith(page, 'admin', 'UpdateUser', 'emil').waitFor();
  assertNoFaults(page);
  await page.context().close();
});

test('a key is created, opens the server, and opens nothing once it is revoked', async () => {
  const page = await browser.newPage();
  await logIn(page, server, 'admin', '/users');
  await page.getByRole('tab', { name: 'API keys' }).click();
  await page.getByRole('button', { name: 'New key' }).click();
  await page.getByRole('textbox', { name: 'Name', exact: true }).fill('robot cell 7');
  await page.getByRole('button', { name: 'Create' }).click();
  const shown = page.getByRole('dialog', { name: 'Key robot cell 7' });
  const key = await shown.locator('pre').innerText();
  await shown.getByRole('button', { name: 'Done' }).click();
  const robot = connect(server.page, key);
  assert.deepEqual((await robot.sequences.listSequences({})).sequences, []);

  await page.getByRole('button', { name: 'Revoke robot cell 7' }).click();
  await page.getByRole('button', { name: 'Revoke', exact: true }).click();
  await rowWith(page, 'robot cell 7').waitFor({ state: 'detached' });
  await until('the key to be worth nothing', () => robot.sequences.listSequences({}).then(() => false, () => true));
  assert.equal(await page.getByText(key).count(), 0);
  await openAudit(page);
  await rowWith(page, 'admin', 'CreateApiKey', 'robot cell 7').waitFor();
  await rowWith(page, 'admin', 'RevokeApiKey').waitFor();
  assertNoFaults(page);
  await page.context().close();
});

test('a session that is ended on the page is worth nothing', async () => {
  const { token } = await connect(server.page).sessions.login({
    user: 'admin',
    password: 'a long enough secret',
    client: 'to be ended',
  });
  const page = await browser.newPage();
  await logIn(page, server, 'admin', '/users');
  await page.getByRole('tab', { name: 'Sessions' }).click();
  await page.getByRole('row').filter({ hasText: 'to be ended' }).getByRole('button').click();
  await page.getByRole('row').filter({ hasText: 'to be ended' }).waitFor({ state: 'detached' });
  await assert.rejects(connect(server.page, token).sessions.whoAmI({}), /unauthenticated/);
  await page.context().close();
});
