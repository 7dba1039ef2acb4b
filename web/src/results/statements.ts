// The SQL that this page asks for: the tables are those of server/results/result_schema.h. What a
// user typed travels as an argument, never inside the text.
import type { Table } from '../gen/visionserver/v1/value_pb';
import { formatNumber } from '../shell/format';
import type { Condition } from './filter';
import { stringValue, toBigint, toNumber, toText, type ValueInit } from './values';

export interface SqlStatement {
  sql: string;
  arguments: ValueInit[];
}

export const newestNumber: SqlStatement = {
  sql: 'SELECT max(number) FROM result',
  arguments: [],
};

export const kNewerLimit = 1000;

// How many results match, up to `kNewerLimit`. With a condition on `number` only those behind it are
// looked at, however many there are in all.
export function countSome({ sql, arguments: values }: Condition): SqlStatement {
  return {
    sql: `SELECT count(*) FROM (SELECT 1 FROM result WHERE ${sql} LIMIT ${kNewerLimit})`,
    arguments: values,
  };
}

export interface Yield {
  total: number;
  pass: number;
  warn: number;
  fail: number;
  // Nothing was judged.
  undefined: number;
}

// No GROUP BY: it would sort all results.
export function countClasses({ sql, arguments: values }: Condition): SqlStatement {
  const columns = ['pass', 'warn', 'fail', 'undefined'].map(
    (word) => `total(result_class = '${word}')`,
  );
  return {
    sql: `SELECT count(*), ${columns.join(', ')} FROM result WHERE ${sql}`,
    arguments: values,
  };
}

export function yieldOf(table: Table | undefined): Yield {
  const [total = 0, pass = 0, warn = 0, fail = 0, unjudged = 0] =
    table?.rows[0]?.cells.map(toNumber) ?? [];
  return { total, pass, warn, fail, undefined: unjudged };
}

// "98.2 %": of the judged results. Rounded down, so that 100 % means all. Empty without any.
export function shareText(count: number, counts: Yield): string {
  const judged = counts.total - counts.undefined;
  return judged === 0 ? '' : `${formatNumber(Math.floor((count / judged) * 1000) / 10, 1)}\u00a0%`;
}

const kBuckets = 500;

// A field over time in at most `kBuckets` steps of equal length, with the least and the greatest
// value of each class in each: however many results there are, no outlier is lost. Columns: time in
// ns, class, least, greatest, count.
export function fieldOverTime(condition: Condition, field: string): SqlStatement {
  const name = `?${condition.arguments.length + 1}`;
  return {
    sql: `
      WITH span AS MATERIALIZED (
        SELECT min(creation_time_ns) AS first_ns,
               (max(creation_time_ns) - min(creation_time_ns)) / ${kBuckets} + 1 AS step_ns
        FROM result WHERE ${condition.sql}),
      point AS (
        SELECT creation_time_ns AS time_ns, result_class,
               (SELECT value FROM json_each(fields)
                WHERE key = ${name} AND type IN ('integer', 'real')) AS value
        FROM result WHERE ${condition.sql})
      SELECT min(time_ns), result_class, min(value), max(value), count(*)
      FROM point, span
      WHERE value IS NOT NULL
      GROUP BY (time_ns - first_ns) / step_ns, result_class
      ORDER BY 1`,
    arguments: [...condition.arguments, stringValue(field)],
  };
}

// Rows of `fieldOverTime`.
export interface Bucket {
  timeS: number;
  resultClass: string;
  least: number;
  greatest: number;
  count: number;
}

export function bucketsOf(table: Table | undefined): Bucket[] {
  return (table?.rows ?? []).map(({ cells }) => ({
    timeS: Number(toBigint(cells[0]) / 1_000n) / 1e6,
    resultClass: toText(cells[1]),
    least: toNumber(cells[2]),
    greatest: toNumber(cells[3]),
    count: toNumber(cells[4]),
  }));
}
