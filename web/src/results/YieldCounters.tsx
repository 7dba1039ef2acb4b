import { Group, Paper, Text } from '@mantine/core';
import { useTranslation } from 'react-i18next';

import { ErrorNote } from '../shell/ErrorNote';
import { formatNumber } from '../shell/format';
import { toCondition, type Selection } from './filter';
import { countClasses, shareText, yieldOf, type Yield } from './statements';
import { useSql } from './useResults';

const words = ['pass', 'warn', 'fail', 'undefined'] as const;

/** How many of the selected results passed; percentages are of those that were judged. */
export function YieldCounters({ selection, nowMs }: { selection: Selection; nowMs: number }) {
  const { t } = useTranslation('results');
  const counted = useSql(
    ['yield', selection, nowMs],
    () => countClasses(toCondition(selection, nowMs)),
    (answer) => yieldOf(answer.table),
  );
  if (counted.isError) return <ErrorNote error={counted.error} />;
  const number = (word: keyof Yield) => (counted.data ? formatNumber(counted.data[word]) : '…');
  return (
    <Group component="dl" gap="sm" m={0} aria-label={t('yield')} aria-busy={counted.isFetching}>
      <Counter label={t('total')} value={number('total')} />
      {words.map((word) => (
        <Counter
          key={word}
          label={t(`classes.${word}`)}
          value={number(word)}
          share={
            counted.data && word !== 'undefined' ? shareText(counted.data[word], counted.data) : ''
          }
        />
      ))}
    </Group>
  );
}

function Counter({ label, value, share = '' }: { label: string; value: string; share?: string }) {
  return (
    <Paper withBorder px="md" py="xs" miw={120}>
      <Text component="dt" size="sm">
        {label}
      </Text>
      <Text component="dd" m={0} size="lg" fw={600} style={{ fontVariantNumeric: 'tabular-nums' }}>
        {value}{' '}
        {share !== '' && (
          <Text span size="sm" fw={400}>
            {share}
          </Text>
        )}
      </Text>
    </Paper>
  );
}
