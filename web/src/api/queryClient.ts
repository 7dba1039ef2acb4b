import { QueryClient } from '@tanstack/react-query';
import { useConnection } from './connection';

/**
 * Asks for all pages and remembers the answers. What fails is not asked for again at once: either
 * the page polls anyway, or the server's text says what to do.
 */
export const queryClient = new QueryClient({
  // Also when the browser believes that it is offline: the server may be on this machine.
  defaultOptions: {
    queries: { retry: false, networkMode: 'always' },
    mutations: { networkMode: 'always' },
  },
});

useConnection.subscribe((state, before) => {
  if (state.recoveries !== before.recoveries) void queryClient.invalidateQueries();
});
