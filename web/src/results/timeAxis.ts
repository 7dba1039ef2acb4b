// The texts of a chart's time axis: local time, 24 hours, in the user's way of writing.

const kMinuteS = 60;
const kDayS = 24 * 3600;
const kMonthS = 28 * kDayS;
const kYearS = 365 * kDayS;

interface Parts {
  fine: Intl.DateTimeFormatOptions;
  // Below the fine one, where it is another than that of the tick before.
  coarse?: Intl.DateTimeFormatOptions;
}

const clock = { hour: '2-digit', minute: '2-digit', hourCycle: 'h23' } as const;
const date = { day: 'numeric', month: 'short', year: 'numeric' } as const;

function partsOf(stepS: number): Parts {
  if (stepS >= kYearS) return { fine: { year: 'numeric' } };
  if (stepS >= kMonthS) return { fine: { month: 'short' }, coarse: { year: 'numeric' } };
  if (stepS >= kDayS) return { fine: { day: 'numeric', month: 'short' }, coarse: { year: 'numeric' } };
  if (stepS >= kMinuteS) return { fine: clock, coarse: date };
  const seconds = { ...clock, second: '2-digit' } as const;
  if (stepS >= 1) return { fine: seconds, coarse: date };
  return { fine: { ...seconds, fractionalSecondDigits: 3 }, coarse: date };
}

// One text for each tick; ticks lie `stepS` seconds apart, times are seconds since 1970 in UTC. The
// date, or the year, stands below the first tick and below each with which it changes.
export function tickTexts(timesS: number[], stepS: number, locale: string): string[] {
  const { fine, coarse } = partsOf(stepS);
  const fineFormat = new Intl.DateTimeFormat(locale, fine);
  const coarseFormat = coarse && new Intl.DateTimeFormat(locale, coarse);
  let before = '';
  return timesS.map((timeS) => {
    const ms = Math.round(timeS * 1e3);
    const text = fineFormat.format(ms);
    const below = coarseFormat?.format(ms) ?? '';
    if (below === before) return text;
    before = below;
    return `${text}\n${below}`;
  });
}
