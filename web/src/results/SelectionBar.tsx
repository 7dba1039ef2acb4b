import { Autocomplete, Button, Group, NativeSelect, TextInput } from '@mantine/core';
import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { api } from '../api/clients';
import { ResultClass, ResultState } from '../gen/visionserver/v1/result_pb';
import { classWords, everything, ranges, stateWords, type Range, type Selection } from './filter';
import { fromLocalInput, toLocalInput } from './time';

interface Props {
  selection: Selection;
  onChange: (selection: Selection) => void;
  onRefresh: () => void;
}

/** Which results the page is about. */
export function SelectionBar({ selection, onChange, onRefresh }: Props) {
  const { t } = useTranslation('results');
  const set = (change: Partial<Selection>) => onChange({ ...selection, ...change });
  const jobs = useQuery({
    queryKey: ['results', 'jobs'],
    queryFn: ({ signal }) => api.sequences.listSequences({}, { signal }),
  });
  return (
    <Group gap="sm" align="end" role="search" aria-label={t('title')}>
      <NativeSelect
        label={t('range')}
        value={selection.range}
        onChange={(event) => set({ range: event.currentTarget.value as Range })}
        data={ranges.map((value) => ({ value, label: t(`ranges.${value}`) }))}
      />
      {selection.range === 'custom' && (
        <>
          <InstantInput label={t('from')} ms={selection.fromMs} onChange={(fromMs) => set({ fromMs })} />
          <InstantInput
            label={t('until')}
            ms={selection.untilMs}
            onChange={(untilMs) => set({ untilMs })}
          />
        </>
      )}
      <WordInput
        label={t('job')}
        value={selection.job}
        onChange={(job) => set({ job })}
        choices={jobs.data?.sequences.map((sequence) => sequence.id) ?? []}
      />
      <NativeSelect
        label={t('class')}
        value={selection.resultClass}
        onChange={(event) => set({ resultClass: Number(event.currentTarget.value) })}
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
        onChange={(event) => set({ state: Number(event.currentTarget.value) })}
        data={[
          { value: String(ResultState.UNSPECIFIED), label: t('any') },
          ...([ResultState.COMPLETED, ResultState.ABORTED, ResultState.FAILED] as const).map(
            (value) => ({ value: String(value), label: t(`states.${stateWords[value]}`) }),
          ),
        ]}
      />
      <WordInput label={t('part')} value={selection.part} onChange={(part) => set({ part })} />
      <Button variant="default" onClick={() => onChange(everything)}>
        {t('reset')}
      </Button>
      <Button onClick={onRefresh}>{t('refresh')}</Button>
    </Group>
  );
}

interface WordProps {
  label: string;
  value: string;
  onChange: (value: string) => void;
  choices?: string[];
}

// Takes effect with Enter, a choice, or when left: not with each letter, which would ask the server.
function WordInput({ label, value, onChange, choices = [] }: WordProps) {
  const [draft, setDraft] = useState(value);
  const [shown, setShown] = useState(value);
  if (value !== shown) {
    setShown(value);
    setDraft(value);
  }
  const commit = (text: string) => {
    if (text.trim() !== value) onChange(text.trim());
  };
  return (
    <Autocomplete
      w={140}
      label={label}
      data={choices}
      value={draft}
      onChange={setDraft}
      onOptionSubmit={commit}
      onBlur={() => commit(draft)}
      onKeyDown={(event) => {
        if (event.key === 'Enter') commit(event.currentTarget.value);
      }}
    />
  );
}

interface InstantProps {
  label: string;
  ms: number | undefined;
  onChange: (ms: number | undefined) => void;
}

function InstantInput({ label, ms, onChange }: InstantProps) {
  return (
    <TextInput
      type="datetime-local"
      step={1}
      label={label}
      title={ms === undefined ? undefined : new Date(ms).toISOString()}
      defaultValue={toLocalInput(ms)}
      onBlur={(event) => onChange(fromLocalInput(event.currentTarget.value))}
    />
  );
}
