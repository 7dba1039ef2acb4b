import { describe, expect, it } from 'vitest';
import { texts } from './texts';

/** "a.b" for each text, with the names that it fills in. */
function keys(node: object, path = ''): string[] {
  return Object.entries(node).flatMap(([key, value]: [string, unknown]) =>
    typeof value === 'string'
      ? [`${path}${key} ${(value.match(/{{\w+}}/g) ?? []).sort().join()}`]
      : keys(value as object, `${path}${key}.`),
  );
}

describe.each(Object.entries(texts))('texts of %s', (_folder, { en, de }) => {
  it('are the same in both languages, with the same values filled in', () => {
    expect(keys(de).sort()).toEqual(keys(en).sort());
  });
  it('are not empty', () => {
    expect(JSON.stringify([en, de])).not.toContain('""');
  });
});
