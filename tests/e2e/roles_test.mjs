// Who may not do something sees no control for it, and is refused by the server all the same.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { assertNoFaults, Browser, logIn, until } from './support/browser.mjs';
import { callFromPage } from './support/call.mjs';
import { waitForNextFrame } from './support/canvas.mjs';
import { liveSequence } from './support/scene.mjs';
import { role, TestServer } from './support/server.mjs';

const permissionDenied = 7; // gRPC's number

let server;
let browser;
before(async () => {
  server = await new TestServer({ live: liveSequence() }).start();
  await server.setUp({ vera: role.viewer, olga: role.operator, emil: role.engineer });
  browser = await Browser.launch();
});
after(async () => {
  await browser?.close();
  await server?.end();
});

const anyControl = 'input, select, textarea, button';
/** Sliders, switches, lists, fields and resets of the parameters, also those that are greyed out. */
const controls = (page) => page.getByTestId('parameters').locator('details').locator(anyControl);

async function openSequence(user) {
  const page = await browser.newPage();
  await logIn(page, server, user, '/sequence/live');
  await waitForNextFrame(page);
  await page.getByTestId('parameter-match.num_disparities').waitFor();
  return page;
}

test('a viewer looks and has no control, nor would the server obey', async () => {
  const page = await openSequence('vera');
  assert.equal(await controls(page).count(), 0);
  assert.equal(await page.getByTestId('parameter-match.num_disparities').getByText('128 px').count(), 1);
  assert.equal(await page.getByRole('button', { name: /^(Start|Stop|Reset)/ }).count(), 0);
  assert.equal(await page.getByRole('link', { name: 'Users' }).count(), 0);
  assert.equal(await page.getByRole('link', { name: 'Audit' }).count(), 0);
  await page.goto(server.page + '/');
  await page.getByText('live').first().waitFor();
  assert.equal(await page.getByRole('button', { name: /^(Start|Stop) live/ }).count(), 0);
  assertNoFaults(page);

  const calls = {
    'ParameterService/SetParameters': {
      sequence: 'live',
      values: [{ path: 'match.num_disparities', value: { kind: { case: 'intValue', value: 64n } } }],
    },
    'SequenceService/StopSequence': { id: 'live' },
    'UserService/ListUsers': {},
    'AuditService/ListAuditEntries': {},
  };
  for (const [method, request] of Object.entries(calls)) {
    const { status, message } = await callFromPage(page, method, request);
    assert.equal(status, permissionDenied, `${method}: ${message}`);
  }
  const { values } = await server.admin.parameters.getParameters({
    sequence: 'live',
    paths: ['match.num_disparities'],
  });
  assert.equal(values[0].value.kind.value, 128n);
  await page.context().close();
});

test('an operator has the controls meant for operators, and no others', async () => {
  const page = await openSequence('olga');
  const field = (name) => page.getByTestId(`parameter-match.${name}`);
  assert.ok(await field('num_disparities').getByRole('slider').isEnabled());
  assert.equal(await field('census').locator(anyControl).count(), 0);
  assert.equal(await field('census').getByTestId('value').count(), 1);
  const { status } = await callFromPage(page, 'ParameterService/SetParameters', {
    sequence: 'live',
    values: [{ path: 'match.census', value: { kind: { case: 'stringValue', value: '5x5' } } }],
  });
  assert.equal(status, permissionDenied);
  await page.context().close();
});

test('a role that is changed while the page is open counts', async () => {
  const page = await openSequence('emil');
  assert.ok((await controls(page).count()) > 10);
  await server.admin.users.updateUser({ name: 'emil', role: role.viewer });
  const { status } = await callFromPage(page, 'SequenceService/StopSequence', { id: 'live' });
  assert.equal(status, permissionDenied);
  // Who comes back to the tab sees it at once, others within half a minute.
  await page.evaluate(() => document.dispatchEvent(new Event('visibilitychange', { bubbles: true })));
  await until('the controls to go', async () => (await controls(page).count()) === 0);
  await page.context().close();
});
