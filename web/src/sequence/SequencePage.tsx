import { Button, Loader, Stack } from '@mantine/core';
import { useQuery } from '@tanstack/react-query';
import { useTranslation } from 'react-i18next';
import { useParams } from 'react-router';
import { api } from '../api/clients';
import { ErrorNote } from '../shell/ErrorNote';
import { usePageTitle } from '../shell/usePageTitle';
import { SequenceView } from './SequenceView';

/** Looks at one sequence while it works: pictures, depth, point cloud, parameters, blocks. */
export default function SequencePage() {
  const { id = '' } = useParams();
  const { t } = useTranslation('sequence');
  usePageTitle(id);
  const query = useQuery({
    queryKey: ['sequence', id],
    // Somebody may edit it meanwhile.
    refetchInterval: 10_000,
    queryFn: async () => {
      const [sequence, { blockTypes }] = await Promise.all([
        api.sequences.getSequence({ id }),
        api.sequences.listBlockTypes({}),
      ]);
      return { sequence, blockTypes };
    },
  });
  if (query.isPending) return <Loader aria-label={t('loading')} />;
  if (query.isError) {
    return (
      <Stack align="flex-start">
        <ErrorNote error={query.error} />
        <Button size="xs" onClick={() => void query.refetch()}>
          {t('again')}
        </Button>
      </Stack>
    );
  }
  const { sequence, blockTypes } = query.data;
  if (!sequence.spec) return null;
  return <SequenceView key={id} sequence={sequence} spec={sequence.spec} blockTypes={blockTypes} />;
}
