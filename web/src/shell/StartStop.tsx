import { Button, type ButtonProps } from '@mantine/core';
import { useMutation } from '@tanstack/react-query';
import { lazy, Suspense, useState } from 'react';
import { useTranslation } from 'react-i18next';
import { api } from '../api/clients';
import { mayOperate, useRole } from '../api/session';
import { SequenceRunState, type SequenceState } from '../gen/visionserver/v1/sequence_pb';
import { notifyError } from './ErrorNote';
import { PlayIcon, StopIcon } from './icons';
import { mayBeStopped } from './runState';

const ConfirmDialog = lazy(() => import('./ConfirmDialog'));

/** Starts a sequence, or stops it after asking; only for roles that may. */
export function StartStop({
  id,
  state,
  size,
  onSettled,
}: {
  id: string;
  state: SequenceRunState;
  size: ButtonProps['size'];
  /** Hears the state after a call, or nothing when it failed. */
  onSettled: (state?: SequenceState) => void;
}) {
  const { t } = useTranslation('shell');
  const role = useRole();
  // Undefined until it is first wanted: only then the dialog is loaded.
  const [asking, setAsking] = useState<boolean>();
  const change = useMutation({
    mutationFn: (run: boolean) =>
      run ? api.sequences.startSequence({ id }) : api.sequences.stopSequence({ id }),
    onError: notifyError,
    onSettled,
  });
  if (!mayOperate(role)) return null;
  const runs = mayBeStopped(state);
  return (
    <>
      <Button
        size={size}
        variant={runs ? 'default' : undefined}
        leftSection={runs ? <StopIcon /> : <PlayIcon />}
        loading={change.isPending || state === SequenceRunState.STOPPING}
        onClick={() => (runs ? setAsking(true) : change.mutate(true))}
        aria-label={t(runs ? 'run.stopNamed' : 'run.startNamed', { name: id })}
      >
        {t(runs ? 'run.stop' : 'run.start')}
      </Button>
      {asking !== undefined && (
        <Suspense fallback={null}>
          <ConfirmDialog
            opened={asking}
            title={t('run.stopTitle', { name: id })}
            text={t('run.stopText')}
            action={t('run.stop')}
            onConfirm={() => {
              setAsking(false);
              change.mutate(false);
            }}
            onCancel={() => setAsking(false)}
          />
        </Suspense>
      )}
    </>
  );
}
