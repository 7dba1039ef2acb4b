import { Group, Stack, Tabs, Title } from '@mantine/core';
import { lazy, Suspense, useEffect, useMemo, useRef, useState } from 'react';
import { useTranslation } from 'react-i18next';
import { useSearchParams } from 'react-router';

import { usePageTitle } from '../shell/usePageTitle';
import { ExportButton } from './ExportButton';
import { readSelection, writeSelection, type Selection } from './filter';
import { ResultDetails } from './ResultDetails';
import { ResultTable } from './ResultTable';
import { SelectionBar } from './SelectionBar';
import { SqlBox } from './SqlBox';
import { YieldCounters } from './YieldCounters';
import { useResultPages } from './useResults';
import { numericFields } from './values';

const FieldChart = lazy(() => import('./FieldChart'));
const views = ['table', 'chart', 'sql'] as const;

/** What sequences found. Everything that is chosen lies in the address, so that it can be shared. */
export default function ResultsPage() {
  const { t } = useTranslation('results');
  usePageTitle(t('title'));
  const [address, setAddress] = useSearchParams();
  // The end of ranges such as the last hour: stands still until the user asks for newer ones.
  const [nowMs, setNowMs] = useState(() => Date.now());
  const selection = useMemo(() => readSelection(address), [address]);
  const pages = useResultPages(selection, nowMs);
  const results = useMemo(() => pages.data?.pages.flatMap((page) => page.results) ?? [], [pages.data]);

  const refresh = () => setNowMs(Date.now());
  // A change may follow another one before the page has been drawn with that.
  const latest = useRef(address);
  useEffect(() => {
    latest.current = address;
  }, [address]);
  const go = (next: URLSearchParams) => {
    latest.current = next;
    setAddress(next);
  };
  const select = (change: Partial<Selection>) => {
    go(writeSelection({ ...readSelection(latest.current), ...change }, latest.current));
    refresh();
  };
  const set = (name: string, value: string) => {
    const changed = new URLSearchParams(latest.current);
    if (value === '') changed.delete(name);
    else changed.set(name, value);
    go(changed);
  };

  return (
    <Stack gap="md" className="vs-panel">
      <Group justify="space-between">
        <Title order={1}>{t('title')}</Title>
        <ExportButton selection={selection} />
      </Group>
      <SelectionBar selection={selection} onChange={select} onRefresh={refresh} />
      <YieldCounters selection={selection} nowMs={nowMs} />
      <Tabs
        value={views.find((view) => view === address.get('view')) ?? 'table'}
        onChange={(view) => set('view', view === 'table' ? '' : (view ?? ''))}
        keepMounted={false}
      >
        <Tabs.List aria-label={t('view')} mb="md">
          {views.map((view) => (
            <Tabs.Tab key={view} value={view}>
              {t(`views.${view}`)}
            </Tabs.Tab>
          ))}
        </Tabs.List>
        <Tabs.Panel value="table">
          <ResultTable
            selection={selection}
            nowMs={nowMs}
            pages={pages}
            results={results}
            onOpen={(id) => set('result', id)}
            onRefresh={refresh}
          />
        </Tabs.Panel>
        <Tabs.Panel value="chart">
          <Suspense fallback={t('loading')}>
            <FieldChart
              selection={selection}
              nowMs={nowMs}
              fields={numericFields(results)}
              field={address.get('field') ?? ''}
              onField={(field) => set('field', field)}
            />
          </Suspense>
        </Tabs.Panel>
        <Tabs.Panel value="sql">
          <SqlBox />
        </Tabs.Panel>
      </Tabs>
      <ResultDetails resultId={address.get('result') ?? ''} onClose={() => set('result', '')} />
    </Stack>
  );
}
