// Queries to start from. The tables are described in server/results/result_schema.h.
export const examples = {
  latest: `SELECT creation_time, job_id, part_id, result_class, fields
FROM result
ORDER BY number DESC
LIMIT 20`,
  yield: `SELECT job_id, count(*) AS results,
  round(100.0 * sum(result_class = 'pass') / count(*), 1) AS pass_percent
FROM result
GROUP BY job_id`,
  hourly: `SELECT strftime('%Y-%m-%d %H:00', creation_time_ns / 1e9, 'unixepoch', 'localtime') AS hour,
  count(*) AS results,
  sum(result_class = 'fail') AS failed
FROM result
WHERE creation_time_ns > (strftime('%s', 'now') - 86400) * 1000000000
GROUP BY hour
ORDER BY hour`,
  fields: `SELECT job_id, name, count(*) AS results,
  min(value) AS least, avg(value) AS mean, max(value) AS greatest
FROM result_field
WHERE typeof(value) IN ('integer', 'real')
  AND number > (SELECT max(number) FROM result) - 10000
GROUP BY job_id, name`,
  slow: `SELECT number, job_id, creation_time, processing_ns / 1e6 AS processing_ms
FROM result
WHERE number > (SELECT max(number) FROM result) - 10000
ORDER BY processing_ns DESC
LIMIT 20`,
  reasons: `SELECT reason, count(*) AS results, max(creation_time) AS latest
FROM result
WHERE result_state <> 'completed'
GROUP BY reason
ORDER BY results DESC`,
  columns: `SELECT name, sql FROM sqlite_master WHERE name IN ('result', 'result_field')`,
};

export type ExampleName = keyof typeof examples;
export const exampleNames = Object.keys(examples) as ExampleName[];
