import { expect, it } from 'vitest';
import { i18next } from '../i18n';
import { formatBytes } from './format';

it('sizes go by thousands, in the language of the page', async () => {
  await i18next.changeLanguage('en');
  expect([999, 3400, 2_500_000n].map(formatBytes)).toEqual(['999 B', '3.4 kB', '2.5 MB']);
  await i18next.changeLanguage('de');
  expect(formatBytes(12_300_000_000n)).toBe('12,3 GB');
  await i18next.changeLanguage('en');
});
