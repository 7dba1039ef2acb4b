import { create } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';

import { TableSchema } from '../gen/visionserver/v1/value_pb';
import { chartData } from './chart';
import { bucketsOf, fieldOverTime, shareText, yieldOf } from './statements';
import { intValue, stringValue, type ValueInit } from './values';

const double = (value: number): ValueInit => ({ kind: { case: 'doubleValue', value } });
const table = (...rows: ValueInit[][]) =>
  create(TableSchema, { rows: rows.map((cells) => ({ cells })) });

describe('yield', () => {
  it('counts shares of what was judged', () => {
    const counts = yieldOf(table([intValue(8n), double(2), double(0), double(1), double(5)]));
    expect(counts).toEqual({ total: 8, pass: 2, warn: 0, fail: 1, undefined: 5 });
    expect(shareText(counts.pass, counts)).toBe('66.6\u00a0%');
  });
  it('says 100 % only when none failed', () => {
    const counts = yieldOf(table([intValue(9999n), double(9998), double(0), double(1), double(0)]));
    expect(shareText(counts.pass, counts)).toBe('99.9\u00a0%');
    expect(shareText(9999, counts)).toBe('100.0\u00a0%');
  });
  it('has no shares when nothing was judged', () => {
    expect(shareText(0, yieldOf(undefined))).toBe('');
  });
});

describe('a value over time', () => {
  it('binds the name of the field behind the arguments of the condition', () => {
    const statement = fieldOverTime({ sql: 'job_id = ?1', arguments: [stringValue('weld')] }, 'gap"mm');
    expect(statement.sql).toContain('key = ?2');
    expect(statement.sql).not.toContain('gap');
    expect(statement.arguments.map((value) => value.kind?.value)).toEqual(['weld', 'gap"mm']);
  });
  it('draws least and greatest of a step, and a single result once, under its class', () => {
    const buckets = bucketsOf(
      table(
        [intValue(1_500_000_000n), stringValue('pass'), double(0.5), double(2.5), intValue(40n)],
        [intValue(2_500_000_000n), stringValue('fail'), intValue(9n), intValue(9n), intValue(1n)],
      ),
    );
    // Times, then not judged, pass, warn, fail.
    expect(chartData(buckets)).toEqual([
      [1.5, 1.5, 2.5],
      [null, null, null],
      [0.5, 2.5, null],
      [null, null, null],
      [null, null, 9],
    ]);
  });
});
