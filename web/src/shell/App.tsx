import { MantineProvider } from '@mantine/core';
import { QueryClientProvider } from '@tanstack/react-query';
import type { ReactNode } from 'react';
import { queryClient } from '../api/queryClient';
import { Messages } from './messages';
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
      <QueryClientProvider client={queryClient}>
        <PageBoundary>{children}</PageBoundary>
        <Messages />
      </QueryClientProvider>
    </MantineProvider>
  );
}
