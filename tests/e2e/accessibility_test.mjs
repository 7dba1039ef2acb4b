// Every page for everybody: no serious finding of axe-core in either theme, and pictures of each.
import { after, before, test } from 'node:test';

import { assertAccessible, assertNoFaults, Browser, logIn, picture, until, userField } from './support/browser.mjs';
import { liveSequence } from './support/scene.mjs';
import { role, TestServer } from './support/server.mjs';

const drawn = (page, canvas) =>
  until(`a picture on ${canvas}`, () => page.getByTestId(canvas).getAttribute('data-frame'));

const pages = {
  overview: { place: '/', ready: (page) => page.getByText('live').first().waitFor() },
  sequence: {
    place: '/sequence/live',
    ready: async (page) => {
      await drawn(page, 'view-map');
      await drawn(page, 'view-picture');
      await page.getByRole('slider').first().waitFor();
    },
  },
  sequence_cloud: {
    place: '/sequence/live',
    ready: async (page) => {
      await page.getByRole('tab', { name: 'Point cloud' }).click();
      await drawn(page, 'view-cloud');
    },
  },
  sequence_blocks: {
    place: '/sequence/live',
    ready: async (page) => {
      await page.getByRole('tab', { name: 'Blocks' }).click();
      await drawn(page, 'preview-match.disparity');
    },
  },
  sequence_stop: {
    place: '/sequence/live',
    ready: async (page) => {
      await page.getByRole('button', { name: 'Stop live' }).click();
      await page.getByRole('dialog', { name: 'Stop live?' }).waitFor();
    },
  },
  results: {
    place: '/results',
    ready: (page) => page.getByRole('button', { name: /^Open result/ }).first().waitFor(),
  },
  results_chart: {
    place: '/results?view=chart',
    ready: (page) => page.getByRole('img', { name: /over time: [1-9]/ }).waitFor(),
  },
  results_sql: {
    place: '/results?view=sql',
    ready: async (page) => {
      await page.getByRole('button', { name: 'Run' }).click();
      await page.getByRole('table', { name: 'Answer' }).waitFor();
    },
  },
  users: { place: '/users', ready: (page) => page.getByRole('cell', { name: 'olga' }).first().waitFor() },
  users_sessions: {
    place: '/users',
    ready: async (page) => {
      await page.getByRole('tab', { name: 'Sessions' }).click();
      await page.getByRole('cell', { name: 'olga' }).first().waitFor();
    },
  },
  users_keys: {
    place: '/users',
    ready: async (page) => {
      await page.getByRole('tab', { name: 'API keys' }).click();
      await page.getByRole('cell', { name: 'palletizer' }).first().waitFor();
    },
  },
  audit: { place: '/audit', ready: (page) => page.getByRole('cell', { name: /CreateUser/ }).first().waitFor() },
};

let server;
let browser;
// Those that are looked at without a word of English.
const inGerman = ['overview', 'sequence', 'users', 'audit'];

before(async () => {
  server = await new TestServer({ live: liveSequence() }).start();
  await server.setUp({ olga: role.operator });
  await server.admin.users.createApiKey({ name: 'palletizer', role: role.robot });
  browser = await Browser.launch();
});
after(async () => {
  await browser?.close();
  await server?.end();
});

for (const colorScheme of ['dark', 'light']) {
  test(`the login in the ${colorScheme} theme`, async () => {
    const page = await browser.newPage({ colorScheme });
    await page.goto(server.page);
    await userField(page).waitFor();
    await picture(page, `login_${colorScheme}`);
    await assertAccessible(page, 'the login');
    await page.context().close();
  });

  test(`all pages in the ${colorScheme} theme`, async (all) => {
    const page = await browser.newPage({ colorScheme, viewport: { width: 1024, height: 768 } });
    await logIn(page, server);
    for (const [name, { place, ready }] of Object.entries(pages)) {
      await all.test(name, async () => {
        await page.goto(server.page + place);
        await ready(page);
        await picture(page, `${name}_${colorScheme}`);
        await assertAccessible(page, name);
        assertNoFaults(page);
      });
    }
    await page.context().close();
  });
}

test('pages in German', async (all) => {
  const page = await browser.newPage({ viewport: { width: 1024, height: 768 } });
  await logIn(page, server);
  await page.evaluate(() => localStorage.setItem('visionserver.language', 'de'));
  for (const name of inGerman) {
    await all.test(name, async () => {
      const { place, ready } = pages[name];
      await page.goto(server.page + place);
      await page.getByRole('link', { name: 'Übersicht' }).waitFor();
      await ready(page);
      await picture(page, `${name}_german`);
      await assertAccessible(page, `${name} in German`);
      assertNoFaults(page);
    });
  }
  await page.context().close();
});
