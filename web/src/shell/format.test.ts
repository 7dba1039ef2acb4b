import { expect, it } from 'vitest';
import { i18next } from '../i18n';
import { formatBytes } from './format';

it('sizes go by thousands, in the language of the page', async () => {
  await i18next.changeLanguage('en');
  expect([999, 3400, 2_500_000n].map(formatBytes)).toEqual(['999\u00a0B', '3.4\u00a0kB', '2.5\u00a0MB']);
  await i18next.changeLanguage('de');
  expect(formatBytes(12_300_000_000n)).toBe('12,3\u00a0GB');
  await i18next.changeLanguage('en');
});
