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
