/** A length with three digits after the point below 10 m, two above: what the eye can use. */
export function metres(value: number, locale: string): string {
  const digits = Math.abs(value) < 10 ? 3 : 2;
  return `${number(value, digits, locale)} m`;
}

/** With so many digits after the point, as the language writes numbers; infinite as "∞". */
export function number(value: number, digits: number, locale: string): string {
  if (!Number.isFinite(value)) return value > 0 ? '∞' : '–∞';
  let format = formats.get(`${locale} ${digits}`);
  if (!format) {
    format = new Intl.NumberFormat(locale, {
      minimumFractionDigits: digits,
      maximumFractionDigits: digits,
      useGrouping: false,
    });
    formats.set(`${locale} ${digits}`, format);
  }
  return format.format(value);
}

const formats = new Map<string, Intl.NumberFormat>();
