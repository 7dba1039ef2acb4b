import { Anchor, Button, Stack, Table, Text } from '@mantine/core';
import { useTranslation } from 'react-i18next';

import type { Result } from '../gen/visionserver/v1/result_pb';
import { userLocale } from '../i18n';
import { ErrorNote } from '../shell/ErrorNote';
import { ClassBadge } from './ClassBadge';
import { stateWords, type Selection } from './filter';
import { kNewerLimit } from './statements';
import { localText, utcText } from './time';
import { useNewerCount, type useResultPages } from './useResults';
import { valueText } from './values';

interface Props {
  selection: Selection;
  nowMs: number;
  pages: ReturnType<typeof useResultPages>;
  results: Result[];
  onOpen: (resultId: string) => void;
  onRefresh: () => void;
}

/** The selected results, newest first. */
export function ResultTable({ selection, nowMs, pages, results, onOpen, onRefresh }: Props) {
  const { t } = useTranslation('results');
  if (pages.isError) return <ErrorNote error={pages.error} />;
  if (pages.isPending) return <Text role="status">{t('loading')}</Text>;
  return (
    <Stack gap="sm">
      <NewerLine selection={selection} nowMs={nowMs} results={results} onRefresh={onRefresh} />
      {results.length === 0 ? (
        <Text>{t('noResults')}</Text>
      ) : (
        <Table.ScrollContainer
          type="native"
          minWidth={800}
          tabIndex={0}
          role="region"
          aria-label={t('views.table')}
        >
          <Table striped highlightOnHover>
            <Table.Thead>
              <Table.Tr>
                {(['time', 'job', 'part', 'class', 'state', 'values', 'reason'] as const).map(
                  (column) => (
                    <Table.Th key={column} scope="col">
                      {t(column)}
                    </Table.Th>
                  ),
                )}
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {results.map((result) => (
                <Row key={result.resultId} result={result} onOpen={onOpen} />
              ))}
            </Table.Tbody>
          </Table>
        </Table.ScrollContainer>
      )}
      {pages.hasNextPage && (
        <Button
          variant="default"
          loading={pages.isFetchingNextPage}
          onClick={() => void pages.fetchNextPage()}
        >
          {t('older')}
        </Button>
      )}
    </Stack>
  );
}

type NewerProps = Pick<Props, 'selection' | 'nowMs' | 'results' | 'onRefresh'>;

function NewerLine({ selection, nowMs, results, onRefresh }: NewerProps) {
  const { t } = useTranslation('results');
  const count = useNewerCount(selection, nowMs, results);
  return (
    <div role="status">
      {count > 0 && (
        <Button variant="light" fullWidth onClick={onRefresh}>
          {count < kNewerLimit ? t('newer', { count }) : t('newerMany', { count: kNewerLimit })}
        </Button>
      )}
    </div>
  );
}

// Names of files have no place to break.
const wrapAnywhere = { overflowWrap: 'anywhere' } as const;

function Row({ result, onOpen }: { result: Result; onOpen: (resultId: string) => void }) {
  const { t } = useTranslation('results');
  const time = localText(result.creationTime, userLocale());
  const state = stateWords[result.resultState];
  return (
    <Table.Tr onClick={() => onOpen(result.resultId)} style={{ cursor: 'pointer' }}>
      <Table.Td style={{ whiteSpace: 'nowrap' }}>
        <Anchor
          component="button"
          type="button"
          size="sm"
          title={utcText(result.creationTime)}
          aria-label={t('open', { number: String(result.number), time })}
        >
          {time}
        </Anchor>
      </Table.Td>
      <Table.Td>{result.jobId}</Table.Td>
      <Table.Td>{result.partId}</Table.Td>
      <Table.Td>
        <ClassBadge resultClass={result.resultClass} />
      </Table.Td>
      <Table.Td>{state && t(`states.${state}`)}</Table.Td>
      <Table.Td style={wrapAnywhere}>
        {result.fields
          .slice(0, 4)
          .map((field) => `${field.name} ${valueText(field.value)}`)
          .join(', ')}
        {result.fields.length > 4 && ' …'}
      </Table.Td>
      <Table.Td style={wrapAnywhere}>{result.reason}</Table.Td>
    </Table.Tr>
  );
}
