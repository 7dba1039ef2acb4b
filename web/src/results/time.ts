// Times are UTC in the API; people see their own, and UTC in a tooltip.
import type { Duration, Timestamp } from '@bufbuild/protobuf/wkt';
import { timestampMs } from '@bufbuild/protobuf/wkt';

import { formatNumber, kNone } from '../shell/format';

// "22/11/2026, 18:31:05.123" in the user's way of writing.
export function localText(time: Timestamp | undefined, locale: string): string {
  return localTextOfMs(time && timestampMs(time), locale);
}

// The same of milliseconds since 1970 in UTC.
export function localTextOfMs(ms: number | undefined, locale: string): string {
  if (ms === undefined) return kNone;
  return new Date(ms).toLocaleString(locale, {
    year: 'numeric',
    month: '2-digit',
    day: '2-digit',
    hour: '2-digit',
    minute: '2-digit',
    second: '2-digit',
    fractionalSecondDigits: 3,
    hourCycle: 'h23',
  });
}

// "2026-11-22T17:31:05.123Z"; empty when there is none.
export function utcText(time: Timestamp | undefined): string {
  return time ? new Date(timestampMs(time)).toISOString() : '';
}

// Milliseconds with one decimal, in the language of the page: "45.5 ms".
export function durationText(duration: Duration | undefined): string {
  if (!duration) return kNone;
  return `${formatNumber(Number(duration.seconds) * 1e3 + duration.nanos / 1e6, 1)}\u00a0ms`;
}

// For an <input type="datetime-local">, which has local time without a zone; and back.
export function toLocalInput(ms: number | undefined): string {
  if (ms === undefined) return '';
  const date = new Date(ms);
  return new Date(ms - date.getTimezoneOffset() * 60_000).toISOString().slice(0, 19);
}

export function fromLocalInput(text: string): number | undefined {
  const ms = text === '' ? NaN : new Date(text).getTime();
  return Number.isNaN(ms) ? undefined : ms;
}
