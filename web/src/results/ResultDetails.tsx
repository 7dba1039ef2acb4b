import { Drawer, Stack, Table, Text, Title } from '@mantine/core';
import { useQuery } from '@tanstack/react-query';
import { useTranslation } from 'react-i18next';

import { pageApi } from '../api/pageClients';
import type { Result } from '../gen/visionserver/v1/result_pb';
import { userLocale } from '../i18n';
import { ErrorNote } from '../shell/ErrorNote';
import { ClassBadge } from './ClassBadge';
import { stateWords } from './filter';
import { ResultFile } from './ResultFile';
import { durationText, localText, utcText } from './time';
import { fileFields, valueText } from './values';

interface Props {
  // Empty: closed.
  resultId: string;
  onClose: () => void;
}

/** One result with everything that is known about it, and its files. */
export function ResultDetails({ resultId, onClose }: Props) {
  const { t } = useTranslation('results');
  const found = useQuery({
    queryKey: ['results', 'one', resultId],
    queryFn: ({ signal }) => pageApi.results.getResult({ resultId }, { signal }),
    enabled: resultId !== '',
    staleTime: Infinity, // a stored result never changes
  });
  const number = found.data ? String(found.data.number) : '';
  return (
    <Drawer
      opened={resultId !== ''}
      onClose={onClose}
      position="right"
      size="lg"
      title={t('resultTitle', { number })}
      closeButtonProps={{ 'aria-label': t('close') }}
    >
      <ErrorNote error={found.error} />
      {found.isFetching && <Text role="status">{t('loading')}</Text>}
      {found.data && <Details result={found.data} />}
    </Drawer>
  );
}

function Details({ result }: { result: Result }) {
  const { t } = useTranslation('results');
  const state = stateWords[result.resultState];
  const time = (stamp: Result['creationTime']) => (
    <span title={utcText(stamp)}>{localText(stamp, userLocale())}</span>
  );
  const files = fileFields(result);
  return (
    <Stack gap="lg">
      <Facts
        rows={[
          [t('class'), <ClassBadge key="class" resultClass={result.resultClass} />],
          [t('state'), state && t(`states.${state}`)],
          [t('reason'), result.reason],
          [t('job'), result.jobId],
          [t('part'), result.partId],
          [t('measId'), result.measId],
          [t('created'), time(result.creationTime)],
          [t('acquired'), time(result.acquisitionTime)],
          [t('processing'), durationText(result.processingDuration)],
          [t('frame'), String(result.frameNumber)],
          [t('revision'), String(result.sequenceRevision)],
          [t('hash'), result.parameterHash],
          [t('resultId'), result.resultId],
        ]}
      />
      <div>
        <Title order={2} size="h4">
          {t('values')}
        </Title>
        {result.fields.length === 0 && <Text>{t('noValues')}</Text>}
        <Facts rows={result.fields.map((field) => [field.name, valueText(field.value, true)])} />
      </div>
      {files.length > 0 && (
        <Stack gap="sm">
          <Title order={2} size="h4">
            {t('files')}
          </Title>
          {files.map((field) => (
            <ResultFile key={field} resultId={result.resultId} field={field} />
          ))}
        </Stack>
      )}
    </Stack>
  );
}

function Facts({ rows }: { rows: [string, React.ReactNode][] }) {
  return (
    <Table>
      <Table.Tbody>
        {rows.map(([name, value]) => (
          <Table.Tr key={name}>
            <Table.Th scope="row" w="40%">
              {name}
            </Table.Th>
            <Table.Td style={{ overflowWrap: 'anywhere' }}>{value}</Table.Td>
          </Table.Tr>
        ))}
      </Table.Tbody>
    </Table>
  );
}
