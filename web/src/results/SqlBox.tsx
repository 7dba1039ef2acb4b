import { Button, Group, NativeSelect, NumberInput, Stack, Textarea } from '@mantine/core';
import { useEffect, useRef, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { pageApi } from '../api/pageClients';
import type { QueryResultsResponse } from '../gen/visionserver/v1/result_pb';
import { ErrorNote } from '../shell/ErrorNote';
import { SqlAnswer } from './SqlAnswer';
import { exampleNames, examples, type ExampleName } from './examples';

interface Outcome {
  answer?: QueryResultsResponse;
  error?: unknown;
  ms: number;
}

/** Asks the server any SELECT; the server sees to it that nothing else is asked. */
export function SqlBox() {
  const { t } = useTranslation('results');
  const [sql, setSql] = useState(examples.latest);
  const [seconds, setSeconds] = useState(5);
  const [maxRows, setMaxRows] = useState(500);
  const [outcome, setOutcome] = useState<Outcome>();
  const [busy, setBusy] = useState(false);
  const running = useRef<AbortController>(null);
  // Whoever leaves the page waits for no answer.
  useEffect(() => () => running.current?.abort(), []);

  const run = async () => {
    if (busy) return;
    const controller = new AbortController();
    running.current = controller;
    setBusy(true);
    const started = performance.now();
    const request = { sql, maxRows, timeout: { seconds: BigInt(seconds) } };
    const result = await pageApi.results.queryResults(request, { signal: controller.signal }).then(
      (answer) => ({ answer }),
      (error: unknown) => ({ error }),
    );
    setOutcome({ ...result, ms: Math.round(performance.now() - started) });
    setBusy(false);
  };

  return (
    <Stack gap="sm">
      <Textarea
        label={t('sql')}
        description={t('sqlHelp')}
        value={sql}
        onChange={(event) => setSql(event.currentTarget.value)}
        onKeyDown={(event) => {
          if (event.key === 'Enter' && (event.ctrlKey || event.metaKey)) void run();
        }}
        rows={9}
        resize="vertical"
        spellCheck={false}
        error={outcome?.error !== undefined}
        styles={{ input: { fontFamily: 'monospace' } }}
      />
      <Group align="end" gap="sm">
        <NativeSelect
          label={t('examples')}
          value={exampleNames.find((name) => examples[name] === sql) ?? ''}
          onChange={(event) => setSql(examples[event.currentTarget.value as ExampleName])}
          data={[
            { value: '', label: '–', disabled: true },
            ...exampleNames.map((value) => ({ value, label: t(`exampleNames.${value}`) })),
          ]}
        />
        <Limit label={t('timeout')} value={seconds} onChange={setSeconds} max={30} />
        <Limit label={t('maxRows')} value={maxRows} onChange={setMaxRows} max={10_000} />
        <Button onClick={() => void run()} loading={busy}>
          {t('run')}
        </Button>
        {busy && (
          <Button variant="default" onClick={() => running.current?.abort()}>
            {t('cancel')}
          </Button>
        )}
      </Group>
      <ErrorNote error={outcome?.error} />
      {outcome?.answer && <SqlAnswer answer={outcome.answer} ms={outcome.ms} />}
    </Stack>
  );
}

interface LimitProps {
  label: string;
  value: number;
  max: number;
  onChange: (value: number) => void;
}

function Limit({ label, value, max, onChange }: LimitProps) {
  return (
    <NumberInput
      w={130}
      label={label}
      value={value}
      min={1}
      max={max}
      allowDecimal={false}
      clampBehavior="strict"
      onChange={(given) => onChange(Number(given) || 1)}
    />
  );
}
