// Debian's Chromium without a screen, and what tests do with every page of ours.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

import { adminPassword, passwordOf } from './server.mjs';
import { chromium, library, libraryFile } from './tools.mjs';

// Only a broken page keeps a test waiting so long; the machine may be busy.
export const patienceMs = Number(process.env.VS_PATIENCE_S ?? 60) * 1000;

const flags = [
  '--no-sandbox',
  '--disable-gpu',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];

export class Browser {
  #browser;

  /** `more` are flags of Chromium. */
  static async launch(more = []) {
    const browser = new Browser();
    const { chromium: launcher } = library('playwright-core');
    browser.#browser = await launcher.launch({ executablePath: chromium, args: [...flags, ...more] });
    return browser;
  }

  /** A page in a browser profile of its own: no cookies, no storage of others. */
  async newPage({ colorScheme = 'dark', locale = 'en-GB', ...options } = {}) {
    const context = await this.#browser.newContext({
      ignoreHTTPSErrors: true, // the server has made its certificate itself
      viewport: { width: 1280, height: 800 },
      colorScheme,
      locale,
      ...options,
    });
    const page = await context.newPage();
    page.setDefaultTimeout(patienceMs);
    // The page is dark unless its user has chosen otherwise.
    await page.addInitScript(
      (scheme) => localStorage.setItem('mantine-color-scheme-value', scheme),
      colorScheme,
    );
    page.faults = [];
    page.on('pageerror', (error) => page.faults.push(String(error)));
    page.on('console', (message) => {
      if (message.type() === 'error') page.faults.push(message.text());
    });
    return page;
  }

  /** Chromium's processes, as { type, id }. */
  async processes() {
    const devTools = await this.#browser.newBrowserCDPSession();
    const { processInfo } = await devTools.send('SystemInfo.getProcessInfo');
    await devTools.detach();
    return processInfo;
  }

  async close() {
    await this.#browser.close();
  }
}

/** Opens a place of the page and logs in as people do. */
export async function logIn(page, server, user = 'admin', place = '/') {
  await page.goto(server.page + place);
  await fillLogin(page, user, user === 'admin' ? adminPassword : passwordOf(user));
  await page.getByRole('navigation').waitFor();
}

/** Where a login begins. */
export const userField = (page) => page.getByRole('textbox', { name: /^(User|Benutzer)/ });

export async function fillLogin(page, user, password) {
  await userField(page).fill(user);
  await page.getByRole('textbox', { name: /^(Password|Passwort)/ }).fill(password);
  await page.getByRole('button', { name: /^(Log in|Anmelden)$/ }).click();
}

/** Nothing went wrong in the page: no exception, no refused resource, no error in the console. */
export function assertNoFaults(page) {
  assert.deepEqual(page.faults, []);
}

/**
 * Stores what the page looks like, where VS_PICTURES names a folder. A page with pictures of cameras
 * is much smaller as `jpeg`.
 */
export async function picture(page, name, type = 'png') {
  const folder = process.env.VS_PICTURES;
  if (!folder) return;
  if (type === 'jpeg') await page.waitForTimeout(4000); // rate and delay are means over seconds
  const [extension, quality] = type === 'jpeg' ? ['jpg', 80] : ['png', undefined];
  await page.screenshot({ path: join(folder, `${name}.${extension}`), type, quality });
}

/** Waits until dialogs and menus have faded in: what is half transparent has too little contrast. */
export async function settled(page) {
  await page.evaluate(() =>
    Promise.allSettled(
      document.getAnimations().map((animation) => animation instanceof CSSTransition && animation.finished),
    ),
  );
}

const axe = readFileSync(libraryFile('axe-core/axe.min.js'), 'utf8');

/** No serious finding of axe-core by WCAG 2.1, A and AA. */
export async function assertAccessible(page, name) {
  await page.evaluate(axe);
  const findings = await page.evaluate(async () => {
    const { violations } = await window.axe.run(document, {
      runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa'],
      resultTypes: ['violations'],
    });
    return violations
      .filter(({ impact }) => impact === 'serious' || impact === 'critical')
      .map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map((node) => `${node.html}: ${node.any[0]?.message ?? ''}`).join('\n')}`);
  });
  assert.deepEqual(findings, [], `accessibility of ${name}`);
}

/** Waits until `probe`, asked again and again, gives something true; gives that. */
export async function until(what, probe) {
  for (const end = Date.now() + patienceMs; Date.now() < end; ) {
    const found = await probe();
    if (found) return found;
    await new Promise((done) => setTimeout(done, 100));
  }
  throw new Error(`waited ${patienceMs / 1000} s in vain: ${what}`);
}
