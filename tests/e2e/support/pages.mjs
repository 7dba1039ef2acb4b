// Every page, with what must be on the screen before it is worth a look. English and German.
import { until } from './browser.mjs';

const drawn = (page, canvas) =>
  until(`a picture on ${canvas}`, () => page.getByTestId(canvas).getAttribute('data-frame'));

// Of a row in the table of results.
const openResult = /^(Open result|Ergebnis \d+ )/;

const firstCell = (page, name) => page.getByRole('cell', { name }).first().waitFor();

/**
 * By name: `place` in the address, `ready`, which opens and awaits what the page is named after, and
 * the `type` of its picture if not png.
 */
export const pages = {
  overview: { place: '/', ready: (page) => page.getByText('live').first().waitFor() },
  sequence: {
    place: '/sequence/live',
    type: 'jpeg',
    ready: async (page) => {
      await drawn(page, 'view-map');
      await drawn(page, 'view-picture');
      await page.getByRole('slider').first().waitFor();
    },
  },
  sequence_cloud: {
    place: '/sequence/live',
    type: 'jpeg',
    ready: async (page) => {
      await page.getByRole('tab', { name: /^(Point cloud|Punktwolke)$/ }).click();
      await drawn(page, 'view-cloud');
    },
  },
  sequence_blocks: {
    place: '/sequence/live',
    ready: async (page) => {
      await page.getByRole('tab', { name: /^(Blocks|Blöcke)$/ }).click();
      await drawn(page, 'preview-match.disparity');
    },
  },
  sequence_stop: {
    place: '/sequence/live',
    ready: async (page) => {
      await page.getByRole('button', { name: /^(Stop live|live anhalten)$/ }).click();
      await page.getByRole('dialog', { name: /^(Stop live\?|live anhalten\?)$/ }).waitFor();
    },
  },
  results: {
    place: '/results',
    ready: (page) => page.getByRole('button', { name: openResult }).first().waitFor(),
  },
  result: {
    place: '/results',
    type: 'jpeg',
    ready: async (page) => {
      const withPicture = page.getByRole('row').filter({ hasText: '.png' }).first();
      await withPicture.getByRole('button', { name: openResult }).click();
      const shown = page.getByRole('dialog', { name: /^(Result|Ergebnis) \d+$/ }).getByRole('img', { name: 'picture' });
      await until('the picture of a result', () => shown.evaluate((canvas) => canvas.width === 648));
    },
  },
  results_chart: {
    place: '/results?view=chart',
    ready: (page) => page.getByRole('img', { name: /valid_percent.*: [1-9]/ }).waitFor(),
  },
  results_sql: {
    place: '/results?view=sql',
    ready: async (page) => {
      await page.getByRole('button', { name: /^(Run|Ausführen)$/ }).click();
      await page.getByRole('table', { name: /^(Answer|Antwort)$/ }).waitFor();
    },
  },
  users: { place: '/users', ready: (page) => firstCell(page, 'olga') },
  users_new: {
    place: '/users',
    ready: async (page) => {
      await page.getByRole('button', { name: /^(New user|Neuer Benutzer)$/ }).click();
      await page.getByRole('dialog').getByRole('combobox').waitFor();
    },
  },
  users_secret: {
    place: '/users',
    ready: async (page) => {
      const reset = /^(Reset password|Passwort zurücksetzen)$/;
      await page.getByRole('button', { name: /^(Actions for|Aktionen für) vera$/ }).click();
      await page.getByRole('menuitem', { name: reset }).click();
      await page.getByRole('button', { name: reset }).click();
      await page.getByRole('dialog', { name: /^(One-time password of|Einmalpasswort von) vera$/ }).waitFor();
    },
  },
  users_sessions: {
    place: '/users',
    ready: async (page) => {
      await page.getByRole('tab', { name: /^(Sessions|Sitzungen)$/ }).click();
      await firstCell(page, 'olga');
    },
  },
  users_keys: {
    place: '/users',
    ready: async (page) => {
      await page.getByRole('tab', { name: /^(API keys|API-Schlüssel)$/ }).click();
      await firstCell(page, 'palletizer');
    },
  },
  users_newkey: {
    place: '/users',
    ready: async (page) => {
      await page.getByRole('tab', { name: /^(API keys|API-Schlüssel)$/ }).click();
      await page.getByRole('button', { name: /^(New key|Neuer Schlüssel)$/ }).click();
      await page.getByRole('dialog').getByRole('combobox').waitFor();
    },
  },
  audit: { place: '/audit', ready: (page) => firstCell(page, /CreateUser/) },
};
