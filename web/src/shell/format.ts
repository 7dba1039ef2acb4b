import { type Timestamp, timestampDate } from '@bufbuild/protobuf/wkt';
import { i18next, userLocale } from '../i18n';

/** What stands where there is no value. */
export const kNone = '–';

/** A number with at most `digits` decimals, in the language of the page. */
export function formatNumber(value: number | bigint, digits = 0): string {
  return new Intl.NumberFormat(i18next.language, {
    maximumFractionDigits: digits,
    minimumFractionDigits: digits,
  }).format(value);
}

/** "12.3 GB", in powers of ten as disks are sold; never broken before the unit. */
export function formatBytes(bytes: bigint | number): string {
  const units = ['B', 'kB', 'MB', 'GB', 'TB', 'PB'];
  let value = Number(bytes);
  let unit = 0;
  while (value >= 1000 && unit < units.length - 1) {
    value /= 1000;
    unit += 1;
  }
  return `${formatNumber(value, unit > 0 ? 1 : 0)}\u00a0${units[unit]}`;
}

/** Date and time to the second, in this machine's time zone. */
export function formatTime(time: Timestamp | undefined): string {
  if (!time) return kNone;
  return new Intl.DateTimeFormat(userLocale(), {
    dateStyle: 'medium',
    timeStyle: 'medium',
    hourCycle: 'h23',
  }).format(timestampDate(time));
}

/** "3 d 4 h", "4 h 12 min", "12 min", "8 s": the two largest parts. */
export function formatDuration(seconds: number): string {
  const whole = Math.max(0, Math.floor(seconds));
  const days = Math.floor(whole / 86400);
  const hours = Math.floor((whole % 86400) / 3600);
  const minutes = Math.floor((whole % 3600) / 60);
  if (days > 0) return `${days} d ${hours} h`;
  if (hours > 0) return `${hours} h ${minutes} min`;
  if (minutes > 0) return `${minutes} min`;
  return `${whole} s`;
}
