// The results page against the server's own SQL.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';

import { value } from './support/api.mjs';
import { assertNoFaults, Browser, logIn, until } from './support/browser.mjs';
import { liveSequence } from './support/scene.mjs';
import { passwordOf, role, TestServer } from './support/server.mjs';

const least = 150; // more than a page of the table

let server;
let browser;
before(async () => {
  server = await new TestServer({ live: liveSequence({ rate_hz: 30, match: { preset: 'single_pass' } }) }).start();
  await server.setUp({ vera: role.viewer });
  await until('results', async () => (await count()) >= least);
  // From here on they stand still.
  await server.admin.sequences.stopSequence({ id: 'live' });
  browser = await Browser.launch();
});
after(async () => {
  await browser?.close();
  await server?.end();
});

async function ask(sql, ...args) {
  const { table } = await server.admin.results.queryResults({ sql, arguments: args, maxRows: 10_000 });
  return table.rows.map(({ cells }) => cells.map(({ kind }) => kind.value));
}
const count = async () => Number((await ask('SELECT count(*) FROM result'))[0][0]);
const rows = (page) => page.getByRole('button', { name: /^Open result/ });

async function openResults(search = '') {
  const page = await browser.newPage();
  await logIn(page, server, 'vera', `/results${search}`);
  return page;
}

test('the export is what SQL answers', async () => {
  const page = await openResults('?job=live');
  await rows(page).first().waitFor();
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: 'Export as CSV' }).click(),
  ]);
  const lines = (await readFile(await download.path(), 'utf8')).trimEnd().split('\r\n');
  const columns = lines[0].split(',');
  const column = (name) => columns.indexOf(name);
  const exported = lines.slice(1).map((line) => {
    const cells = line.split(',');
    return ['number', 'result_id', 'result_class', 'valid_percent'].map((name) => cells[column(name)]);
  });
  const answered = await ask(
    `SELECT number, result_id, result_class, fields ->> 'valid_percent' FROM result
     WHERE job_id = ?1 ORDER BY number`,
    value.text('live'),
  );
  assert.ok(answered.length >= least);
  assert.deepEqual(exported, answered.map((row) => row.map(String)));
  assertNoFaults(page);
  await page.context().close();
});

test('an export during which the session ends is saved after the login', async () => {
  const page = await openResults('?job=live');
  await rows(page).first().waitFor();
  const endSession = async (route) => {
    const { sessions } = await server.admin.users.listSessions({ user: 'vera' });
    for (const { id } of sessions) await server.admin.sessions.revokeSession({ sessionId: id });
    await route.continue();
  };
  await page.route('**/ExportResults', endSession, { times: 1 });
  const download = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Export as CSV' }).click();
  const dialog = page.getByRole('dialog', { name: 'Log in again' });
  await dialog.getByLabel(/^Password/).fill(passwordOf('vera'));
  await dialog.getByRole('button', { name: 'Log in', exact: true }).click();
  const lines = (await readFile(await (await download).path(), 'utf8')).trimEnd().split('\r\n');
  assert.equal(lines.length - 1, await count());
  await page.context().close();
});

test('limits of time are typed and stepped, and follow the address', async () => {
  const page = await openResults('?range=custom');
  const from = page.getByLabel('From');
  // Whatever comes first, day or month, and with the hours of a morning.
  const typed = '2026-11-11T08:30:05';
  const chosen = (local) =>
    until(`results from ${local}`, async () => {
      const instant = await page.evaluate((time) => new Date(time).toISOString(), local);
      return new URL(page.url()).searchParams.get('from') === instant;
    });
  await from.focus();
  await page.keyboard.type('11112026');
  await page.keyboard.press('ArrowRight');
  await page.keyboard.type('083005A');
  assert.equal(await from.inputValue(), typed);
  assert.equal(new URL(page.url()).searchParams.get('from'), null);
  await page.keyboard.press('Enter');
  await chosen(typed);
  for (let i = 0; i < 6; ++i) await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('ArrowUp');
  const stepped = await from.inputValue();
  assert.match(stepped, /^2026-(11-12|12-11)T08:30:05$/);
  await chosen(stepped);
  await page.keyboard.type('01');
  assert.match(await from.inputValue(), /^2026-(11-01|01-11)T08:30:05$/);
  await page.keyboard.press('Escape');
  await until('what was chosen', async () => (await from.inputValue()) === stepped);
  await page.goBack();
  await until('the field to follow', async () => (await from.inputValue()) === typed);
  assertNoFaults(page);
  await page.context().close();
});

test('pages follow each other, and the yield is that of SQL', async () => {
  const page = await openResults();
  await rows(page).nth(99).waitFor();
  assert.equal(await rows(page).count(), 100);
  await page.getByRole('button', { name: 'Show older results' }).click();
  await until('the next page', async () => (await rows(page).count()) > 100);
  const numbers = await rows(page).evaluateAll((buttons) =>
    buttons.map((button) => Number(button.getAttribute('aria-label').match(/\d+/)[0])),
  );
  const newest = await ask('SELECT number FROM result ORDER BY number DESC LIMIT ?1', value.int(numbers.length));
  assert.deepEqual(numbers, newest.map(([number]) => Number(number)));

  const [[all, passed]] = await ask("SELECT count(*), sum(result_class = 'pass') FROM result");
  const counters = page.getByLabel('Yield');
  await until('the counters', async () => {
    const text = (await counters.innerText()).replace(/[\s,]+/g, ' ');
    return text.includes(`Results ${all} `) && text.includes(`pass ${passed} `);
  });
  await page.context().close();
});

test('a link keeps the filter, and newer results are offered, not pushed', async () => {
  const page = await openResults('?class=fail');
  await page.getByText('No results match').waitFor();
  await page.getByLabel('Class').selectOption('pass');
  await rows(page).first().waitFor();
  assert.equal(new URL(page.url()).searchParams.get('class'), 'pass');

  const before = await count();
  await server.admin.sequences.startSequence({ id: 'live' });
  await until('newer results', async () => (await count()) > before + 3);
  await server.admin.sequences.stopSequence({ id: 'live' });
  const shown = await rows(page).first().getAttribute('aria-label');
  const offer = page.getByRole('button', { name: /newer results?: show/ });
  await offer.waitFor();
  assert.equal(await rows(page).first().getAttribute('aria-label'), shown);
  await offer.click();
  await until('the newer ones', async () => (await rows(page).first().getAttribute('aria-label')) !== shown);
  await page.context().close();
});

test('what is searched for is found, and everything again after a reset', async () => {
  const page = await openResults();
  await rows(page).first().waitFor();
  const search = page.getByRole('search');
  await search.getByLabel('Class').selectOption('fail');
  await page.getByText('No results match').waitFor();
  await search.getByLabel('State').selectOption('completed');
  await search.getByLabel('Job').fill('another');
  await search.getByLabel('Job').press('Enter');
  await until('the filters in the address', () => {
    const { searchParams } = new URL(page.url());
    return searchParams.get('job') === 'another' && searchParams.get('state') === 'completed';
  });

  await search.getByRole('button', { name: 'Reset filter' }).click();
  await rows(page).first().waitFor();
  assert.deepEqual([...new URL(page.url()).searchParams.keys()], []);
  assert.equal(await search.getByLabel('Job').inputValue(), '');

  await search.getByLabel('Job').fill('live');
  await search.getByLabel('Job').press('Enter');
  await search.getByLabel('Class').selectOption('pass');
  const [[found]] = await ask("SELECT count(*) FROM result WHERE job_id = 'live' AND result_class = 'pass'");
  await until('the found ones to be counted', async () =>
    (await page.getByLabel('Yield').innerText()).replace(/[\s,]+/g, ' ').includes(`Results ${found} `),
  );
  await page.context().close();
});

test('a row opens its record with its picture', async () => {
  const [[number, id]] = await ask(
    "SELECT number, result_id FROM result WHERE fields ->> 'picture' LIKE '%.png' ORDER BY number DESC LIMIT 1",
  );
  const page = await openResults(`?result=${id}`);
  const record = page.getByRole('dialog', { name: `Result ${number}` });
  await record.getByText(id).waitFor();
  await record.getByText('valid_percent').waitFor();
  const shown = record.getByRole('img', { name: 'picture' });
  await until('the disparities', () => shown.evaluate((canvas) => canvas.width === 648));
  await record.getByRole('button', { name: /^Download .*\.png/ }).waitFor();
  assertNoFaults(page);
  await page.context().close();
});

test('the chart knows every number', async () => {
  const page = await openResults('?view=chart&range=all');
  const [[all, smallest, largest]] = await ask(
    "SELECT count(*), min(fields ->> 'valid_percent'), max(fields ->> 'valid_percent') FROM result",
  );
  const text = (number) => String(Number(number.toPrecision(6)));
  await page
    .getByRole('img', {
      name: `valid_percent over time: ${all} results, least ${text(smallest)}, greatest ${text(largest)}`,
    })
    .waitFor();
  assertNoFaults(page);
  await page.context().close();
});

test('the SQL box answers a viewer, and refuses to write', async () => {
  const page = await openResults('?view=sql');
  const box = page.getByLabel('Query');
  await box.fill('SELECT count(*) AS n FROM result');
  await box.press('Control+Enter');
  await page.getByRole('cell', { name: String(await count()), exact: true }).waitFor();
  page.faults.length = 0;
  await box.fill('DELETE FROM result');
  await box.press('Control+Enter');
  await page.getByRole('alert').filter({ hasText: 'only a SELECT' }).waitFor();
  await page.context().close();
});
