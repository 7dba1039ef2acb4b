import { Button, Group, NativeSelect } from '@mantine/core';
import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { api } from '../api/clients';
import { ResultClass, ResultState } from '../gen/visionserver/v1/result_pb';
import { classWords, everything, ranges, stateWords, type Range, type Selection } from './filter';
import { InstantInput, WordInput } from './SelectionInputs';

interface Props {
  selection: Selection;
  onChange: (change: Partial<Selection>) => void;
  onRefresh: () => void;
}

/** Which results the page is about. */
export function SelectionBar({ selection, onChange, onRefresh }: Props) {
  const { t } = useTranslation('results');
  // Fields are new after a reset: nothing that was typed and is still on its way stays in them.
  const [resets, setResets] = useState(0);
  const jobs = useQuery({
    queryKey: ['results', 'jobs'],
    queryFn: ({ signal }) => api.sequences.listSequences({}, { signal }),
  });
  return (
    <Group gap="sm" align="end" role="search" aria-label={t('title')}>
      <NativeSelect
        label={t('range')}
        value={selection.range}
        onChange={(event) => onChange({ range: event.currentTarget.value as Range })}
        data={ranges.map((value) => ({ value, label: t(`ranges.${value}`) }))}
      />
      {selection.range === 'custom' && (
        <>
          <InstantInput
            key={`from ${resets}`}
            label={t('from')}
            ms={selection.fromMs}
            onChange={(fromMs) => onChange({ fromMs })}
          />
          <InstantInput
            key={`until ${resets}`}
            label={t('until')}
            ms={selection.untilMs}
            onChange={(untilMs) => onChange({ untilMs })}
          />
        </>
      )}
      <WordInput
        key={`job ${resets}`}
        label={t('job')}
        value={selection.job}
        onChange={(job) => onChange({ job })}
        choices={jobs.data?.sequences.map((sequence) => sequence.id) ?? []}
      />
      <NativeSelect
        label={t('class')}
        value={selection.resultClass}
        onChange={(event) => onChange({ resultClass: Number(event.currentTarget.value) })}
        data={[
          { value: String(ResultClass.UNSPECIFIED), label: t('any') },
          ...[ResultClass.PASS, ResultClass.WARN, ResultClass.FAIL].map((value) => ({
            value: String(value),
            label: t(`classes.${classWords[value]}`),
          })),
        ]}
      />
      <NativeSelect
        label={t('state')}
        value={selection.state}
        onChange={(event) => onChange({ state: Number(event.currentTarget.value) })}
        data={[
          { value: String(ResultState.UNSPECIFIED), label: t('any') },
          ...([ResultState.COMPLETED, ResultState.ABORTED, ResultState.FAILED] as const).map(
            (value) => ({ value: String(value), label: t(`states.${stateWords[value]}`) }),
          ),
        ]}
      />
      <WordInput
        key={`part ${resets}`}
        label={t('part')}
        value={selection.part}
        onChange={(part) => onChange({ part })}
      />
      <Button
        variant="default"
        onClick={() => {
          setResets(resets + 1);
          onChange(everything);
        }}
      >
        {t('reset')}
      </Button>
      <Button onClick={onRefresh}>{t('refresh')}</Button>
    </Group>
  );
}
