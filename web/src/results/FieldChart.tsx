import 'uplot/dist/uPlot.min.css';

import { NativeSelect, Stack, Text, useComputedColorScheme } from '@mantine/core';
import { useEffect, useMemo, useRef } from 'react';
import { useTranslation } from 'react-i18next';
import uPlot from 'uplot';

import { userLocale } from '../i18n';
import { ErrorNote } from '../shell/ErrorNote';
import { chartData, chartOptions, kHeightPx } from './chart';
import { toCondition, type Selection } from './filter';
import { bucketsOf, fieldOverTime, type Bucket } from './statements';
import { useSql } from './useResults';

interface Props {
  selection: Selection;
  nowMs: number;
  // To choose from.
  fields: string[];
  // Empty: the first one.
  field: string;
  onField: (field: string) => void;
}

const noBuckets: Bucket[] = [];

/** One measured value of the selected results over time. */
export default function FieldChart({ selection, nowMs, fields, field, onField }: Props) {
  const { t } = useTranslation('results');
  const drawn = field || (fields[0] ?? '');
  const points = useSql(
    ['chart', selection, nowMs, drawn],
    () => fieldOverTime(toCondition(selection, nowMs), drawn),
    (answer) => bucketsOf(answer.table),
    { enabled: drawn !== '' },
  );
  if (drawn === '') return <Text>{t('noFields')}</Text>;
  return (
    <Stack gap="sm">
      <NativeSelect
        w={240}
        label={t('field')}
        value={drawn}
        onChange={(event) => onField(event.currentTarget.value)}
        data={fields.includes(drawn) ? fields : [drawn, ...fields]}
      />
      <ErrorNote error={points.error} />
      {points.isPending && <Text role="status">{t('loading')}</Text>}
      <Plot buckets={points.data ?? noBuckets} field={drawn} />
      <Text size="sm">{t('chartNote')}</Text>
    </Stack>
  );
}

// uPlot draws into a canvas of its own; this only gives it a place, and words for who cannot see it.
function Plot({ buckets, field }: { buckets: Bucket[]; field: string }) {
  const { t } = useTranslation('results');
  const dark = useComputedColorScheme('dark') === 'dark';
  const place = useRef<HTMLDivElement>(null);
  const data = useMemo(() => chartData(buckets), [buckets]);

  useEffect(() => {
    const parent = place.current;
    if (!parent) return;
    const names = {
      time: t('time'),
      undefined: t('classes.undefined'),
      pass: t('classes.pass'),
      warn: t('classes.warn'),
      fail: t('classes.fail'),
    };
    const chart = new uPlot(chartOptions(parent.clientWidth, dark, names, userLocale()), data, parent);
    const resized = new ResizeObserver(() =>
      chart.setSize({ width: parent.clientWidth, height: kHeightPx }),
    );
    resized.observe(parent);
    return () => {
      resized.disconnect();
      chart.destroy();
    };
  }, [data, dark, t]);

  const limit = (value: number) => (Number.isFinite(value) ? String(Number(value.toPrecision(6))) : '–');
  return (
    <div
      ref={place}
      role="img"
      aria-label={t('chartLabel', {
        field,
        count: buckets.reduce((sum, bucket) => sum + bucket.count, 0),
        least: limit(Math.min(...buckets.map((bucket) => bucket.least))),
        greatest: limit(Math.max(...buckets.map((bucket) => bucket.greatest))),
      })}
    />
  );
}
