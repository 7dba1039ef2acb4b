// Users and audit, as an administrator sees them.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { connect } from './support/api.mjs';
import { assertNoFaults, Browser, logIn, until } from './support/browser.mjs';
import { passwordOf, role, TestServer } from './support/server.mjs';

let server;
let browser;
before(async () => {
  server = await new TestServer().start();
  await server.setUp({ olga: role.operator });
  browser = await Browser.launch();
});
after(async () => {
  await browser?.close();
  await server?.end();
});

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

  await page.getByRole('link', { name: 'Audit' }).click();
  const entry = (...texts) =>
    texts.reduce((found, hasText) => found.filter({ hasText }), page.getByRole('row'));
  await entry('admin', 'CreateUser', 'vera').first().waitFor();
  await entry('admin', 'UpdateUser', 'olga').first().waitFor();
  // The refused login, with the reason.
  await entry('Login', 'olga').first().waitFor();
  await page.getByRole('textbox', { name: 'Call' }).fill('CreateUser');
  await until('only those entries', async () => (await entry('Login').count()) === 0);
  assert.ok((await entry('CreateUser').count()) >= 2);
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
