import { MantineProvider } from '@mantine/core';
import { QueryClient, QueryClientProvider } from '@tanstack/react-query';
import { fireEvent, render, screen } from '@testing-library/react';
import { expect, it } from 'vitest';

import { everything } from './filter';
import { SelectionBar } from './SelectionBar';
import '../i18n';

it('keeps nothing of what was typed after a reset, also when no selection had followed it yet', () => {
  // What is chosen arrives here, and does not come back: as on a page that is busy.
  const changes: unknown[] = [];
  const client = new QueryClient({ defaultOptions: { queries: { enabled: false } } });
  render(
    <MantineProvider env="test">
      <QueryClientProvider client={client}>
        <SelectionBar
          selection={{ ...everything }}
          onChange={(change) => changes.push(change)}
          onRefresh={() => undefined}
        />
      </QueryClientProvider>
    </MantineProvider>,
  );
  const job = () => screen.getByRole<HTMLInputElement>('combobox', { name: 'Job' });
  fireEvent.change(job(), { target: { value: 'another' } });
  fireEvent.keyDown(job(), { key: 'Enter' });
  expect(changes).toEqual([{ job: 'another' }]);
  expect(job().value).toBe('another');
  fireEvent.click(screen.getByRole('button', { name: 'Reset filter' }));
  expect(changes.at(-1)).toEqual(everything);
  expect(job().value).toBe('');
});
