import { timestampFromDate } from '@bufbuild/protobuf/wkt';
import { Button, Group, Table, Text, TextInput, Title } from '@mantine/core';
import { useDebouncedValue } from '@mantine/hooks';
import { keepPreviousData, useInfiniteQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { useTranslation } from 'react-i18next';
import { pageApi } from '../api/pageClients';
import { ErrorNote } from '../shell/ErrorNote';
import { formatTime, kNone } from '../shell/format';
import { usePageTitle } from '../shell/usePageTitle';
import { WideTable } from '../shell/WideTable';

const kPageSize = 100;
const kTypingMs = 300;

const toTimestamp = (local: string) => (local ? timestampFromDate(new Date(local)) : undefined);

/** "/visionserver.v1.SequenceService/StartSequence" without what is the same in all of them. */
const shortMethod = (method: string) => method.replace(/^\/visionserver\.v1\./, '');

/** Who changed what, newest first. */
export default function AuditPage() {
  const { t } = useTranslation('admin');
  usePageTitle(t('audit'));
  const [filter, setFilter] = useState({ user: '', method: '', from: '', until: '' });
  const [settled] = useDebouncedValue(filter, kTypingMs);
  const entries = useInfiniteQuery({
    queryKey: ['admin', 'audit', settled],
    queryFn: ({ signal, pageParam }) =>
      pageApi.audit.listAuditEntries(
        {
          user: settled.user.trim(),
          method: settled.method.trim(),
          from: toTimestamp(settled.from),
          until: toTimestamp(settled.until),
          pageSize: kPageSize,
          pageToken: pageParam,
        },
        { signal },
      ),
    initialPageParam: '',
    getNextPageParam: (page) => page.nextPageToken || undefined,
    placeholderData: keepPreviousData,
  });
  const rows = entries.data?.pages.flatMap((page) => page.entries) ?? [];
  const field = (name: keyof typeof filter) => ({
    label: t(name),
    value: filter[name],
    onChange: (event: { currentTarget: HTMLInputElement }) => {
      const { value } = event.currentTarget;
      setFilter((before) => ({ ...before, [name]: value }));
    },
  });
  return (
    <div className="vs-panel">
      <Title order={1} mb="sm">
        {t('audit')}
      </Title>
      <Group align="flex-end" mb="md">
        <TextInput w={130} {...field('user')} />
        <TextInput w={190} placeholder="StartSequence" {...field('method')} />
        <TextInput w={215} type="datetime-local" {...field('from')} />
        <TextInput w={215} type="datetime-local" {...field('until')} />
        <Button variant="default" loading={entries.isRefetching} onClick={() => entries.refetch()}>
          {t('refresh')}
        </Button>
      </Group>
      <ErrorNote error={entries.error} />
      <WideTable label={t('audit')}>
        <Table.Thead>
          <Table.Tr>
            <Table.Th>{t('time')}</Table.Th>
            <Table.Th>{t('user')}</Table.Th>
            <Table.Th>{t('address')}</Table.Th>
            <Table.Th>{t('method')}</Table.Th>
            <Table.Th>{t('subject')}</Table.Th>
            <Table.Th>{t('outcome')}</Table.Th>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {rows.map((entry) => (
            <Table.Tr key={String(entry.number)}>
              <Table.Td style={{ whiteSpace: 'nowrap' }}>{formatTime(entry.time)}</Table.Td>
              <Table.Td fw={600}>{entry.user || kNone}</Table.Td>
              <Table.Td>{entry.address || kNone}</Table.Td>
              <Table.Td title={entry.method}>{shortMethod(entry.method)}</Table.Td>
              <Table.Td style={{ overflowWrap: 'anywhere' }}>{entry.subject || kNone}</Table.Td>
              <Table.Td>
                {entry.ok ? (
                  t('ok')
                ) : (
                  <Text size="sm" c="var(--vs-bad)">
                    {entry.message}
                  </Text>
                )}
              </Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </WideTable>
      {entries.isSuccess && rows.length === 0 && <Text c="dimmed">{t('noEntries')}</Text>}
      {entries.hasNextPage && (
        <Button
          variant="default"
          mt="sm"
          loading={entries.isFetchingNextPage}
          onClick={() => entries.fetchNextPage()}
        >
          {t('older')}
        </Button>
      )}
    </div>
  );
}
