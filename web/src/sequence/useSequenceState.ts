import { useQuery } from '@tanstack/react-query';
import { api } from '../api/clients';
import { SequenceRunState } from '../gen/visionserver/v1/sequence_pb';

/** What a sequence is doing, asked once a second while the tab is visible. */
export function useSequenceState(id: string) {
  return useQuery({
    queryKey: ['sequence-state', id],
    queryFn: ({ signal }) => api.sequences.getSequenceState({ id }, { signal }),
    refetchInterval: 1000,
  });
}

/** Has blocks that work, or are about to. */
export function isRunning(state: SequenceRunState | undefined): boolean {
  return (
    state === SequenceRunState.STARTING ||
    state === SequenceRunState.RUNNING ||
    state === SequenceRunState.DEGRADED ||
    state === SequenceRunState.STOPPING
  );
}
