import { Button } from '@mantine/core';
import { useMutation, useQueryClient } from '@tanstack/react-query';
import { useTranslation } from 'react-i18next';
import { api } from '../api/clients';
import { mayOperate, useRole } from '../api/session';
import { SequenceRunState, type SequenceState } from '../gen/visionserver/v1/sequence_pb';
import { notifyError } from '../shell/ErrorNote';
import { PlayIcon, StopIcon } from '../shell/icons';
import { isRunning } from './useSequenceState';

/** Starts or stops the sequence; only for roles that may. */
export function StartStop({ id, state }: { id: string; state: SequenceState | undefined }) {
  const { t } = useTranslation('sequence');
  const role = useRole();
  const queries = useQueryClient();
  const change = useMutation({
    mutationFn: (start: boolean) =>
      start ? api.sequences.startSequence({ id }) : api.sequences.stopSequence({ id }),
    onSuccess: (next) => queries.setQueryData(['sequence-state', id], next),
    onError: notifyError,
  });
  if (!mayOperate(role) || !state) return null;
  const running = isRunning(state.state);
  return (
    <Button
      size="compact-sm"
      variant="default"
      leftSection={running ? <StopIcon /> : <PlayIcon />}
      loading={change.isPending || state.state === SequenceRunState.STOPPING}
      onClick={() => change.mutate(!running)}
    >
      {running ? t('stop') : t('start')}
    </Button>
  );
}
