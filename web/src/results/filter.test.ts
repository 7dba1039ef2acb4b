import { timestampMs } from '@bufbuild/protobuf/wkt';
import type { Timestamp } from '@bufbuild/protobuf/wkt';
import { describe, expect, it } from 'vitest';

import { ResultClass, ResultState } from '../gen/visionserver/v1/result_pb';
import { everything, readSelection, toCondition, toFilter, writeSelection, type Selection } from './filter';

const nowMs = Date.UTC(2026, 10, 22, 12);
const custom: Selection = {
  range: 'custom',
  fromMs: Date.UTC(2026, 0, 2, 3, 4, 5),
  untilMs: Date.UTC(2026, 0, 3),
  job: 'weld & glue',
  part: 'a/7',
  resultClass: ResultClass.FAIL,
  state: ResultState.ABORTED,
};

describe('the address of the page', () => {
  it('says everything that is chosen, so that a link can be shared', () => {
    const link = writeSelection(custom, new URLSearchParams()).toString();
    expect(readSelection(new URLSearchParams(link))).toEqual(custom);
  });
  it('says nothing of defaults and keeps what belongs to others', () => {
    const before = new URLSearchParams('?view=chart&class=fail');
    expect(writeSelection(everything, before).toString()).toBe('view=chart');
  });
  it('opens with defaults where it is mistyped', () => {
    const mistyped = new URLSearchParams('?range=1y&class=good&state=7&from=soon');
    expect(readSelection(mistyped)).toEqual({ ...everything, fromMs: undefined, untilMs: undefined });
  });
});

describe('the filter for the server', () => {
  it('counts the last hour from now and has no end', () => {
    const filter = toFilter(everything, nowMs);
    expect(timestampMs(filter.from as Timestamp)).toBe(nowMs - 3_600_000);
    expect(filter.until).toBeUndefined();
  });
  it('has no times for all results', () => {
    expect(toFilter({ ...everything, range: 'all' }, nowMs)).toMatchObject({
      from: undefined,
      until: undefined,
    });
  });
  it('takes over what was chosen', () => {
    expect(toFilter(custom, nowMs)).toMatchObject({
      jobId: 'weld & glue',
      partId: 'a/7',
      resultClass: ResultClass.FAIL,
      resultState: ResultState.ABORTED,
    });
  });
});

describe('the condition of SQL', () => {
  it('binds what users typed and never contains it', () => {
    const { sql, arguments: values } = toCondition({ ...custom, job: "' OR 1 --" }, nowMs, 7n);
    expect(sql).toBe(
      "number > ?1 AND job_id = ?2 AND part_id <> '' AND part_id = ?3 AND result_class = ?4" +
        ' AND result_state = ?5 AND creation_time_ns >= ?6 AND creation_time_ns < ?7',
    );
    expect(values.map((value) => value.kind?.value)).toEqual([
      7n,
      "' OR 1 --",
      'a/7',
      'fail',
      'aborted',
      1767323045000000000n, // 2026-01-02T03:04:05Z
      1767398400000000000n, // 2026-01-03T00:00:00Z
    ]);
  });
  it('is true for all results', () => {
    expect(toCondition({ ...everything, range: 'all' }, nowMs)).toEqual({ sql: 'true', arguments: [] });
  });
});
