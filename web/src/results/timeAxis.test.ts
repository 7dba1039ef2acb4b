import { expect, it } from 'vitest';

import { chartOptions } from './chart';
import { tickTexts } from './timeAxis';

const local = (year: number, month: number, ...rest: number[]) =>
  new Date(year, month, ...rest).getTime() / 1e3;

it('has German names in German, and 24 hours', () => {
  const evening = [local(2026, 9, 22, 18), local(2026, 9, 22, 21), local(2026, 9, 23, 0)];
  expect(tickTexts(evening, 3 * 3600, 'de')).toEqual(['18:00\n22. Okt. 2026', '21:00', '00:00\n23. Okt. 2026']);
  expect(tickTexts(evening, 3 * 3600, 'en-GB')).toEqual(['18:00\n22 Oct 2026', '21:00', '00:00\n23 Oct 2026']);
  expect(tickTexts(evening, 3 * 3600, 'en-US')[1]).toBe('21:00');
});

it('says as much as its steps need', () => {
  const times = [local(2026, 11, 31, 23, 59, 59, 500), local(2027, 0, 1)];
  const at = (stepS: number) => tickTexts(times, stepS, 'de');
  expect(at(0.5)).toEqual(['23:59:59,500\n31. Dez. 2026', '00:00:00,000\n1. Jan. 2027']);
  expect(at(1)).toEqual(['23:59:59\n31. Dez. 2026', '00:00:00\n1. Jan. 2027']);
  expect(at(86_400)).toEqual(['31. Dez.\n2026', '1. Jan.\n2027']);
  expect(at(30 * 86_400)).toEqual(['Dez\n2026', 'Jan\n2027']);
  expect(at(365 * 86_400)).toEqual(['2026', '2027']);
});

it('is the axis of the chart; numbers and the legend are written alike', () => {
  const names = { time: 'Zeit', undefined: '', pass: '', warn: '', fail: '' };
  const { axes, series } = chartOptions(600, true, names, 'de');
  const values = axes![0]!.values as (...axis: unknown[]) => string[];
  expect(values({}, [local(2026, 4, 2, 13, 5)], 0, 0, 60)).toEqual(['13:05\n2. Mai 2026']);
  const numbers = axes![1]!.values as (...axis: unknown[]) => string[];
  expect(numbers({}, [87.64, 0.1 + 0.2])).toEqual(['87,64', '0,3']);
  const legend = series[0]!.value as (...value: unknown[]) => string;
  expect(legend({}, local(2026, 4, 2, 13, 5, 7))).toBe('02.05.2026, 13:05:07,000');
  expect(legend({}, null)).toBe('–');
});
