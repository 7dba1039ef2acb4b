// How uPlot draws a value over time: points only, one series for each class.
import type uPlot from 'uplot';

import type { Bucket } from './statements';
import { classWords } from './filter';
import { localTextOfMs } from './time';
import { tickTexts } from './timeAxis';

export const kHeightPx = 360;
// For the longest text of a tick, such as "22. Nov. 2026".
const kTickPx = 90;

type ClassWord = (typeof classWords)[number];

// Readable on both backgrounds, and told apart by people who do not see red and green: fails are
// also larger.
const colors: Record<ClassWord, { dark: string; light: string; size: number }> = {
  undefined: { dark: '#adb5bd', light: '#495057', size: 4 },
  pass: { dark: '#4dabf7', light: '#1864ab', size: 4 },
  warn: { dark: '#ffd43b', light: '#b35c00', size: 6 },
  fail: { dark: '#ff6b6b', light: '#c92a2a', size: 8 },
};

// Times in seconds, then the values of each class: the least and the greatest of each bucket.
export function chartData(buckets: Bucket[]): uPlot.AlignedData {
  const times: number[] = [];
  const series = classWords.map((): (number | null)[] => []);
  for (const { timeS, resultClass, least, greatest } of buckets) {
    for (const value of least === greatest ? [least] : [least, greatest]) {
      times.push(timeS);
      series.forEach((values, i) => values.push(classWords[i] === resultClass ? value : null));
    }
  }
  return [times, ...series];
}

export function chartOptions(
  widthPx: number,
  dark: boolean,
  names: Record<ClassWord | 'time', string>,
  locale: string,
): uPlot.Options {
  const stroke = dark ? '#c9c9c9' : '#343a40';
  const number = new Intl.NumberFormat(locale, { maximumSignificantDigits: 10 });
  const grid = { stroke: dark ? '#424242' : '#dee2e6' };
  return {
    width: widthPx,
    height: kHeightPx,
    axes: [
      {
        stroke,
        grid,
        space: kTickPx,
        values: (_, timesS, _axis, _space, stepS) => tickTexts(timesS, stepS, locale),
      },
      { stroke, grid, size: 80, values: (_, values) => values.map((value) => number.format(value)) },
    ],
    series: [
      { label: names.time, value: (_, timeS) => localTextOfMs(timeS === null ? undefined : timeS * 1e3, locale) },
      ...classWords.map((word) => {
        const color = colors[word][dark ? 'dark' : 'light'];
        return {
          label: names[word],
          stroke: color,
          paths: () => null,
          points: { show: true, size: colors[word].size, fill: color },
        };
      }),
    ],
  };
}
