import { create } from '@bufbuild/protobuf';
import { DurationSchema } from '@bufbuild/protobuf/wkt';
import { afterEach, expect, it } from 'vitest';

import { i18next } from '../i18n';
import { durationText } from './time';

afterEach(() => i18next.changeLanguage('en'));

it('writes milliseconds in the language of the page', async () => {
  const duration = create(DurationSchema, { seconds: 1n, nanos: 45_460_000 });
  expect(durationText(duration)).toBe('1,045.5\u00a0ms');
  await i18next.changeLanguage('de');
  expect(durationText(duration)).toBe('1.045,5\u00a0ms');
  expect(durationText(undefined)).toBe('–');
});
