// Which results are meant: as the address of the page says it, as the server's calls take it, and as
// a condition of SQL.
import type { MessageInitShape } from '@bufbuild/protobuf';
import { timestampFromMs } from '@bufbuild/protobuf/wkt';

import { ResultClass, ResultState, type ResultFilterSchema } from '../gen/visionserver/v1/result_pb';
import { intValue, stringValue, type ValueInit } from './values';

export const ranges = ['10m', '1h', '1d', 'all', 'custom'] as const;
export type Range = (typeof ranges)[number];

const lengthsMs: Partial<Record<Range, number>> = {
  '10m': 10 * 60_000,
  '1h': 3_600_000,
  '1d': 24 * 3_600_000,
};
const kDefaultRange: Range = '1h';

// The words of the store and of the address.
export const classWords = ['undefined', 'pass', 'warn', 'fail'] as const;
export const stateWords = ['', 'completed', 'aborted', 'failed'] as const;

export interface Selection {
  range: Range;
  // UTC; only with the range `custom`.
  fromMs?: number;
  untilMs?: number;
  // Empty: any.
  job: string;
  part: string;
  // UNSPECIFIED: any.
  resultClass: ResultClass;
  state: ResultState;
}

export const everything: Selection = {
  range: kDefaultRange,
  job: '',
  part: '',
  resultClass: ResultClass.UNSPECIFIED,
  state: ResultState.UNSPECIFIED,
};

function instantOf(text: string | null): number | undefined {
  const ms = text === null ? NaN : Date.parse(text);
  return Number.isNaN(ms) ? undefined : ms;
}

// What the address does not say, or says wrongly, has its default: a mistyped link still opens.
export function readSelection(address: URLSearchParams): Selection {
  const range = ranges.find((name) => name === address.get('range')) ?? kDefaultRange;
  const resultClass = classWords.findIndex((word) => word === address.get('class'));
  const state = stateWords.findIndex((word) => word === address.get('state'));
  return {
    range,
    ...(range === 'custom' && {
      fromMs: instantOf(address.get('from')),
      untilMs: instantOf(address.get('until')),
    }),
    job: address.get('job') ?? '',
    part: address.get('part') ?? '',
    resultClass: Math.max(resultClass, 0),
    state: Math.max(state, 0),
  };
}

// Puts the selection into an address; its other entries stay.
export function writeSelection(selection: Selection, address: URLSearchParams): URLSearchParams {
  const { range, fromMs, untilMs, job, part, resultClass, state } = selection;
  const custom = (ms?: number) =>
    range === 'custom' && ms !== undefined ? new Date(ms).toISOString() : '';
  const entries: Record<string, string> = {
    range: range === kDefaultRange ? '' : range,
    from: custom(fromMs),
    until: custom(untilMs),
    job,
    part,
    class: resultClass === ResultClass.UNSPECIFIED ? '' : classWords[resultClass],
    state: stateWords[state],
  };
  const written = new URLSearchParams(address);
  for (const [name, value] of Object.entries(entries)) {
    if (value === '') written.delete(name);
    else written.set(name, value);
  }
  return written;
}

// The limits in UTC, with `nowMs` as the end of ranges such as the last hour. Those have no limit
// above: what arrives later belongs to them.
export function limitsOf(selection: Selection, nowMs: number): { fromMs?: number; untilMs?: number } {
  if (selection.range === 'custom') {
    return { fromMs: selection.fromMs, untilMs: selection.untilMs };
  }
  const lengthMs = lengthsMs[selection.range];
  return lengthMs === undefined ? {} : { fromMs: nowMs - lengthMs };
}

// For ListResults and ExportResults.
export function toFilter(
  selection: Selection,
  nowMs: number,
): MessageInitShape<typeof ResultFilterSchema> {
  const { fromMs, untilMs } = limitsOf(selection, nowMs);
  return {
    jobId: selection.job,
    partId: selection.part,
    resultClass: selection.resultClass,
    resultState: selection.state,
    from: fromMs === undefined ? undefined : timestampFromMs(fromMs),
    until: untilMs === undefined ? undefined : timestampFromMs(untilMs),
  };
}

export interface Condition {
  // Of the columns of `result`; `?1`, `?2` ... stand for the arguments.
  sql: string;
  arguments: ValueInit[];
}

const kNsPerMs = 1_000_000n;

// The same for QueryResults; with `afterNumber` only results stored later.
export function toCondition(selection: Selection, nowMs: number, afterNumber?: bigint): Condition {
  const { fromMs, untilMs } = limitsOf(selection, nowMs);
  const parts: [string, ValueInit][] = [];
  if (afterNumber !== undefined) parts.push(['number >', intValue(afterNumber)]);
  if (selection.job !== '') parts.push(['job_id =', stringValue(selection.job)]);
  // Says what the partial index over parts wants to hear.
  if (selection.part !== '') parts.push(["part_id <> '' AND part_id =", stringValue(selection.part)]);
  if (selection.resultClass !== ResultClass.UNSPECIFIED) {
    parts.push(['result_class =', stringValue(classWords[selection.resultClass])]);
  }
  if (selection.state !== ResultState.UNSPECIFIED) {
    parts.push(['result_state =', stringValue(stateWords[selection.state])]);
  }
  if (fromMs !== undefined) parts.push(['creation_time_ns >=', intValue(BigInt(fromMs) * kNsPerMs)]);
  if (untilMs !== undefined) parts.push(['creation_time_ns <', intValue(BigInt(untilMs) * kNsPerMs)]);
  return {
    sql: parts.length === 0 ? 'true' : parts.map(([text], i) => `${text} ?${i + 1}`).join(' AND '),
    arguments: parts.map(([, value]) => value),
  };
}
