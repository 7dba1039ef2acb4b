import { Stack, Text, Title, VisuallyHidden } from '@mantine/core';
import type { UseQueryResult } from '@tanstack/react-query';
import type { ReactNode } from 'react';
import { useTranslation } from 'react-i18next';
import { isConnectionLost } from '../api/errors';
import { ErrorNote } from '../shell/ErrorNote';
import { usePageTitle } from '../shell/usePageTitle';
import { AlarmList } from './AlarmList';
import { CameraTable } from './CameraTable';
import { MachineFigures } from './MachineFigures';
import { useAlarms, useCameras, useSequences } from './queries';
import { SequenceTable } from './SequenceTable';

/** A titled panel that shows data, or why there is none. A lost connection has its own banner. */
function Section<Data>({
  title,
  query,
  children,
}: {
  title: string;
  query: UseQueryResult<Data>;
  children: (data: Data) => ReactNode;
}) {
  return (
    <div className="vs-panel">
      <Title order={2} mb="sm">
        {title}
      </Title>
      {!isConnectionLost(query.error) && <ErrorNote error={query.error} />}
      {query.data !== undefined && children(query.data)}
    </div>
  );
}

/** What the server does at this moment: alarms, sequences, cameras, machine. */
export default function OverviewPage() {
  const { t } = useTranslation('overview');
  usePageTitle(t('title'));
  const empty = (text: string) => (
    <Text size="sm" c="dimmed">
      {text}
    </Text>
  );
  return (
    <Stack gap="sm">
      <VisuallyHidden>
        <Title order={1}>{t('title')}</Title>
      </VisuallyHidden>
      <MachineFigures />
      <Section title={t('alarms')} query={useAlarms()}>
        {(data) => <AlarmList alarms={data.alarms} />}
      </Section>
      <Section title={t('sequences')} query={useSequences()}>
        {(rows) => (rows.length ? <SequenceTable rows={rows} /> : empty(t('noSequences')))}
      </Section>
      <Section title={t('cameras')} query={useCameras()}>
        {(data) =>
          data.cameras.length ? <CameraTable cameras={data.cameras} /> : empty(t('noCameras'))
        }
      </Section>
    </Stack>
  );
}
