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
  audit: { place: '/audit', ready: (page) => page.getByRole('cell', { name: /CreateUser/ }).first().waitFor() },
};

let server;
let browser;
before(async () => {
  server = await new TestServer({ live: liveSequence() }).start();
  await server.setUp({ olga: role.operator });
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
