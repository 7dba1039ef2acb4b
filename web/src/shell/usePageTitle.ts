import { useQuery } from '@tanstack/react-query';
import { useEffect } from 'react';
import { api } from '../api/clients';

/** Name and version of the server; asked once. */
export function useServerInfo() {
  return useQuery({
    queryKey: ['serverInfo'],
    queryFn: ({ signal }) => api.system.getServerInfo({}, { signal }),
    staleTime: Infinity,
  }).data;
}

/** Names the browser's tab: what the page shows, then which server it is. */
export function usePageTitle(page: string): void {
  const server = useServerInfo()?.name;
  useEffect(() => {
    document.title = [page, server, 'VisionServer'].filter(Boolean).join(' · ');
  }, [page, server]);
}
