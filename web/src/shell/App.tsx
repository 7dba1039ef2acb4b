import { MantineProvider } from '@mantine/core';
import { Notifications } from '@mantine/notifications';
import { QueryClientProvider } from '@tanstack/react-query';
import type { ReactNode } from 'react';
import { queryClient } from '../api/queryClient';
import { PageBoundary } from './PageErrors';
import { cssVariables, theme } from './theme';

/** Everything that all pages need around them. `env`: tests have no transitions. */
export function App({ children, env }: { children: ReactNode; env?: 'default' | 'test' }) {
  return (
    <MantineProvider
      theme={theme}
      cssVariablesResolver={cssVariables}
      defaultColorScheme="dark"
      env={env}
    >
      <Notifications position="bottom-right" />
      <QueryClientProvider client={queryClient}>
        <PageBoundary>{children}</PageBoundary>
      </QueryClientProvider>
    </MantineProvider>
  );
}
