import { useQuery } from '@tanstack/react-query';
import { api } from '../api/clients';
import { pageApi } from '../api/pageClients';
import {
  type Sequence,
  SequenceRunState,
  type SequenceState,
} from '../gen/visionserver/v1/sequence_pb';

// Unary calls, not watch streams: a browser opens six connections to a server at most, over all its
// tabs, and the one stream of a tab is for pictures. Hidden tabs do not poll.
const kFastMs = 1000;
const kSlowMs = 2000;

/** A stored sequence and, unless it is stopped, what it is doing. */
export interface SequenceRow {
  sequence: Sequence;
  state?: SequenceState;
}

async function loadSequences(signal: AbortSignal): Promise<SequenceRow[]> {
  const options = { signal };
  const { sequences } = await api.sequences.listSequences({}, options);
  return Promise.all(
    sequences.map(async (sequence) => ({
      sequence,
      state:
        sequence.runState === SequenceRunState.STOPPED
          ? undefined
          : await api.sequences.getSequenceState({ id: sequence.id }, options),
    })),
  );
}

export function useSequences() {
  return useQuery({
    queryKey: ['overview', 'sequences'],
    queryFn: ({ signal }) => loadSequences(signal),
    refetchInterval: kFastMs,
  });
}

export function useCameras() {
  return useQuery({
    queryKey: ['overview', 'cameras'],
    queryFn: ({ signal }) => pageApi.cameras.listCameras({}, { signal }),
    refetchInterval: kFastMs,
  });
}

export function useAlarms() {
  return useQuery({
    queryKey: ['overview', 'alarms'],
    queryFn: ({ signal }) => api.system.listAlarms({}, { signal }),
    refetchInterval: kSlowMs,
  });
}

export function useResources() {
  return useQuery({
    queryKey: ['overview', 'resources'],
    queryFn: ({ signal }) => api.system.getResources({}, { signal }),
    refetchInterval: kSlowMs,
  });
}

export function useStatistics() {
  return useQuery({
    queryKey: ['overview', 'statistics'],
    queryFn: ({ signal }) => api.system.getStatistics({}, { signal }),
    refetchInterval: kSlowMs,
  });
}
