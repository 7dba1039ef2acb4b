// What the page asks the server for, as queries that TanStack Query keeps and repeats.
import { useInfiniteQuery, useQuery, type UseQueryResult } from '@tanstack/react-query';

import { pageApi } from '../api/pageClients';
import type { QueryResultsResponse, Result } from '../gen/visionserver/v1/result_pb';
import { toCondition, toFilter, type Selection } from './filter';
import { countSome, newestNumber, type SqlStatement } from './statements';
import { toNumber } from './values';

const kPageSize = 100;
const kPollMs = 5000;
// The server's own limit, which says why, comes before that of the call.
const kTimeout = { seconds: 10n };

// One statement of this page; `key` tells it apart from others.
export function useSql<T>(
  key: readonly unknown[],
  statement: () => SqlStatement,
  read: (answer: QueryResultsResponse) => T,
  options: { enabled?: boolean; refetchInterval?: number } = {},
): UseQueryResult<T> {
  return useQuery({
    queryKey: ['results', 'sql', ...key],
    queryFn: async ({ signal }) =>
      read(
        await pageApi.results.queryResults(
          { ...statement(), maxRows: 10_000, timeout: kTimeout },
          { signal },
        ),
      ),
    ...options,
  });
}

// The results of a selection, newest first, page by page.
export function useResultPages(selection: Selection, nowMs: number) {
  return useInfiniteQuery({
    queryKey: ['results', 'list', selection, nowMs],
    initialPageParam: '',
    queryFn: ({ pageParam, signal }) =>
      pageApi.results.listResults(
        { filter: toFilter(selection, nowMs), pageSize: kPageSize, pageToken: pageParam },
        { signal },
      ),
    getNextPageParam: (page) => page.nextPageToken || undefined,
  });
}

// How many results came after those shown: looked for every few seconds while the tab is visible,
// among what is newer only.
export function useNewerCount(selection: Selection, nowMs: number, shown: Result[]): number {
  const newest = useSql(['newest', nowMs], () => newestNumber, numberOf);
  const newestShown = Number(shown[0]?.number ?? 0n);
  const after = Math.max(newest.data ?? 0, newestShown);
  const newer = useSql(
    ['newer', selection, nowMs, after],
    () => countSome(toCondition(selection, nowMs, BigInt(after))),
    numberOf,
    { enabled: newest.isSuccess, refetchInterval: kPollMs },
  );
  return newer.data ?? 0;
}

// The only cell; 0 when it is empty.
function numberOf(answer: QueryResultsResponse): number {
  return toNumber(answer.table?.rows[0]?.cells[0]) || 0;
}
