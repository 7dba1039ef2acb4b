// @vitest-environment node
import { existsSync, readFileSync } from 'node:fs';
import { expect, it } from 'vitest';

const sources = import.meta.glob<string>('../**/*.tsx', {
  query: '?raw',
  import: 'default',
  eager: true,
});

function componentsOf(source: string): string[] {
  const imports = source.matchAll(/import {([^}]*)} from '@mantine\/core'/g);
  return [...imports].flatMap((match) => (match[1] ?? '').split(',').map((name) => name.trim()));
}

it('every component that a page uses has its styles', () => {
  const loaded = readFileSync('src/shell/mantineStyles.ts', 'utf8');
  const used = new Set(Object.values(sources).flatMap(componentsOf));
  const missing = [...used].filter(
    (name) =>
      existsSync(`node_modules/@mantine/core/styles/${name}.css`) &&
      !loaded.includes(`/${name}.css'`),
  );
  expect(used.size).toBeGreaterThan(10);
  expect(missing).toEqual([]);
});
