// Every page for everybody: no serious finding of axe-core on the smallest window that is promised, and
// all controls inside of it; dialogs and messages as well. And pictures of each page.
import { after, before, test } from 'node:test';

import { assertAccessible, assertNoFaults, Browser, fillLogin, logIn, picture, settled, until, userField } from './browser.mjs';
import { assertFits } from './layout.mjs';
import { pages } from './pages.mjs';
import { liveSequence } from './scene.mjs';
import { role, TestServer } from './server.mjs';

const smallest = { width: 1024, height: 768 };
// A word that is on every page for administrators.
const languages = { en: 'Overview', de: 'Übersicht' };

let server;
let browser;
before(async () => {
  server = await new TestServer({ live: liveSequence() }).start();
  await server.setUp({ olga: role.operator, vera: role.viewer, emil: role.engineer });
  await server.admin.users.createApiKey({ name: 'palletizer', role: role.robot });
  browser = await Browser.launch();
  await until('a result with a picture', async () => {
    const { frames } = await server.admin.sequences.getSequenceState({ id: 'live' });
    return frames > 60n; // one of each 50
  });
});
after(async () => {
  await browser?.close();
  await server?.end();
});

async function look(page, name, type) {
  await settled(page);
  await picture(page, name, type);
  await assertAccessible(page, name);
  await assertFits(page, name);
}

/** A page whose user has chosen this language. */
async function pageIn(language, colorScheme) {
  const page = await browser.newPage({ colorScheme, viewport: smallest });
  await page.addInitScript((chosen) => localStorage.setItem('visionserver.language', chosen), language);
  return page;
}

/** Makes the tests of all pages in a theme and a language. */
export function testPages(colorScheme, language) {
  const kind = `${colorScheme}_${language}`;

  test(`the login, ${kind}`, async () => {
    const page = await pageIn(language, colorScheme);
    await page.goto(server.page);
    await userField(page).waitFor();
    await look(page, `login_${kind}`);
    await page.context().close();
  });

  test(`all pages, ${kind}`, async (all) => {
    const page = await pageIn(language, colorScheme);
    await logIn(page, server);
    await page.getByRole('link', { name: languages[language] }).waitFor();
    for (const [name, { place, ready, type }] of Object.entries(pages)) {
      await all.test(name, async () => {
        await page.goto(server.page + place);
        await ready(page);
        await look(page, `${name}_${kind}`, type);
        assertNoFaults(page);
      });
    }
    await page.context().close();
  });

  test(`the first password, ${kind}`, async () => {
    const page = await pageIn(language, colorScheme);
    const { oneTimePassword } = await server.admin.users.resetPassword({ name: 'vera' });
    await page.goto(server.page);
    await fillLogin(page, 'vera', oneTimePassword);
    await page.getByRole('button', { name: /^(Change password|Passwort ändern)$/ }).waitFor();
    await look(page, `first_password_${kind}`);
    await page.context().close();
  });

  test(`the session that has ended, ${kind}`, async () => {
    const page = await pageIn(language, colorScheme);
    await logIn(page, server, 'emil');
    const { sessions } = await server.admin.users.listSessions({ user: 'emil' });
    for (const { id } of sessions) await server.admin.sessions.revokeSession({ sessionId: id });
    await page.getByRole('dialog', { name: /^(Log in again|Erneut anmelden)$/ }).waitFor();
    await look(page, `session_ended_${kind}`);
    await page.context().close();
  });

  test(`the lost connection, ${kind}`, async () => {
    const page = await pageIn(language, colorScheme);
    await logIn(page, server, 'emil');
    await pages.overview.ready(page);
    await page.context().setOffline(true);
    await page.getByText(/^(Connection to the server lost|Verbindung zum Server verloren)/).waitFor();
    await look(page, `connection_lost_${kind}`);
    await page.context().close();
  });
}
