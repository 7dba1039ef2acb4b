import { useQuery } from '@tanstack/react-query';
import { api } from '../api/clients';

/** Under what the state of a sequence is remembered. */
export const stateKey = (id: string) => ['sequence-state', id];

/** What a sequence is doing, asked once a second while the tab is visible. */
export function useSequenceState(id: string) {
  return useQuery({
    queryKey: stateKey(id),
    queryFn: ({ signal }) => api.sequences.getSequenceState({ id }, { signal }),
    refetchInterval: 1000,
  });
}
