import { Alert, Stack, Table, Text } from '@mantine/core';
import { useTranslation } from 'react-i18next';

import type { QueryResultsResponse } from '../gen/visionserver/v1/result_pb';
import { isNumber, valueText } from './values';

/** What a query found. */
export function SqlAnswer({ answer, ms }: { answer: QueryResultsResponse; ms: number }) {
  const { t } = useTranslation('results');
  const columns = answer.table?.columns ?? [];
  const rows = answer.table?.rows ?? [];
  return (
    <Stack gap="xs">
      <Text role="status" size="sm">
        {t('rows', { count: rows.length, ms })}
      </Text>
      {answer.truncated && <Alert color="yellow">{t('truncated', { count: rows.length })}</Alert>}
      <Table.ScrollContainer
        type="native"
        minWidth={400}
        mah={480}
        style={{ overflowY: 'auto' }}
        tabIndex={0}
        role="region"
        aria-label={t('answer')}
      >
        <Table striped stickyHeader withColumnBorders aria-label={t('answer')}>
          <Table.Thead>
            <Table.Tr>
              {columns.map((column) => (
                <Table.Th key={column} scope="col">
                  {column}
                </Table.Th>
              ))}
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {rows.map((row, index) => (
              <Table.Tr key={index}>
                {row.cells.map((cell, column) => (
                  <Table.Td
                    key={columns[column]}
                    ta={isNumber(cell) ? 'right' : 'left'}
                    style={{ whiteSpace: 'pre-wrap' }}
                  >
                    {valueText(cell, true)}
                  </Table.Td>
                ))}
              </Table.Tr>
            ))}
          </Table.Tbody>
        </Table>
      </Table.ScrollContainer>
    </Stack>
  );
}
