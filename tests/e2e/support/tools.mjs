// What the tests are made of and where it lies. The libraries are those of web/, the programs those
// of the build that VS_BUILD names.
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

export const root = join(dirname(fileURLToPath(import.meta.url)), '..', '..', '..');
export const build = process.env.VS_BUILD ?? join(root, 'build', 'release');
export const program = (name) => join(build, 'bin', name);

const chromium = process.env.VS_CHROMIUM ?? '/usr/bin/chromium';
const fromWeb = createRequire(join(root, 'web', 'package.json'));

/** A library of web/package.json. */
export const library = (name) => fromWeb(name);
export const libraryFile = (name) => fromWeb.resolve(name);
export { chromium };

// First thing in every test: without a browser or a page there is nothing to test.
const missing =
  (!existsSync(chromium) && 'no browser: install the package chromium') ||
  (!existsSync(join(build, 'web', 'index.html')) && 'no page: it was not built (VS_WEB)');
if (missing) {
  console.log(`[  SKIPPED ] ${missing}`);
  process.exit(0);
}
