import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { pageApi } from '../api/pageClients';

const kRefreshMs = 5000;

export function useUsers() {
  return useQuery({
    queryKey: ['admin', 'users'],
    queryFn: ({ signal }) => pageApi.users.listUsers({}, { signal }),
    refetchInterval: kRefreshMs,
  });
}

export function useAllSessions() {
  return useQuery({
    queryKey: ['admin', 'sessions'],
    queryFn: ({ signal }) => pageApi.users.listSessions({}, { signal }),
    refetchInterval: kRefreshMs,
  });
}

export function useApiKeys() {
  return useQuery({
    queryKey: ['admin', 'keys'],
    queryFn: ({ signal }) => pageApi.users.listApiKeys({}, { signal }),
    refetchInterval: kRefreshMs,
  });
}

/** A call that changes something; all tables here are asked for anew after it. */
export function useChange<Argument, Answer>(
  call: (argument: Argument) => Promise<Answer>,
  handlers: { onSuccess?: (answer: Answer) => void; onError?: (error: unknown) => void } = {},
) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: call,
    ...handlers,
    onSettled: () => client.invalidateQueries({ queryKey: ['admin'] }),
  });
}
