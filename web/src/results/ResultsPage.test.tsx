import { MantineProvider } from '@mantine/core';
import { QueryClient, QueryClientProvider } from '@tanstack/react-query';
import { fireEvent, render, screen, within } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { MemoryRouter, useLocation } from 'react-router';
import { beforeEach, expect, it, vi } from 'vitest';

import '../i18n';
import { ResultClass, ResultState } from '../gen/visionserver/v1/result_pb';
import { asked, held } from './fakeResults';
import ResultsPage from './ResultsPage';

vi.mock('../api/clients', async () => ({ api: (await import('./fakeResults')).fakeApi }));
vi.mock('../api/pageClients', async () => ({ pageApi: (await import('./fakeResults')).fakeApi }));

function Address() {
  return <output>{useLocation().search}</output>;
}

function open(search = '') {
  render(
    <MantineProvider env="test">
      <QueryClientProvider client={new QueryClient({ defaultOptions: { queries: { retry: false } } })}>
        <MemoryRouter initialEntries={[`/results${search}`]}>
          <ResultsPage />
          <Address />
        </MemoryRouter>
      </QueryClientProvider>
    </MantineProvider>,
  );
}

const address = () => new URLSearchParams(document.querySelector('output')?.textContent ?? '');
const rowButtons = () => screen.findAllByRole('button', { name: /^Open result/ });

beforeEach(() => {
  asked.lists = [];
  asked.queries = [];
  held.count = 5;
});

it('shows the newest results first and older ones when asked', async () => {
  open();
  expect(await rowButtons()).toHaveLength(3);
  expect(screen.getAllByText(/^part-/).map((cell) => cell.textContent)).toEqual([
    'part-5',
    'part-4',
    'part-3',
  ]);
  await userEvent.click(screen.getByRole('button', { name: 'Show older results' }));
  expect(await screen.findByText('part-1')).toBeTruthy();
  expect(asked.lists.map((request) => request.pageToken)).toEqual(['', '3']);
  expect(screen.queryByRole('button', { name: 'Show older results' })).toBeNull();
});

it('takes its filter from the address and writes it there', async () => {
  open('?job=weld&class=fail&state=aborted&part=a%2F7');
  await rowButtons();
  expect(asked.lists[0]?.filter).toMatchObject({
    jobId: 'weld',
    partId: 'a/7',
    resultClass: ResultClass.FAIL,
    resultState: ResultState.ABORTED,
  });
  await userEvent.selectOptions(screen.getByLabelText('Class'), 'pass');
  expect(address().get('class')).toBe('pass');
  await userEvent.type(screen.getByRole('combobox', { name: 'Part' }), '8{Enter}');
  expect(address().get('part')).toBe('a/78');
  await vi.waitFor(() =>
    expect(asked.lists.at(-1)?.filter).toMatchObject({ partId: 'a/78', resultClass: ResultClass.PASS }),
  );
});

it('offers what came since, without moving what is read', async () => {
  vi.useFakeTimers({ shouldAdvanceTime: true });
  open();
  await rowButtons();
  held.count = 7;
  await vi.advanceTimersByTimeAsync(5100);
  const newer = await screen.findByRole('button', { name: '2 newer results: show' });
  expect(screen.queryByText('part-7')).toBeNull();
  fireEvent.click(newer);
  expect(await screen.findByText('part-7')).toBeTruthy();
  vi.useRealTimers();
});

it('opens a result, with a link of its own', async () => {
  open();
  await userEvent.click((await rowButtons())[0]!);
  expect(address().get('result')).toBe('id-5');
  const details = await screen.findByRole('dialog');
  expect(await within(details).findByText('too wide')).toBeTruthy();
  expect(within(details).getByText('gap_mm')).toBeTruthy();
  expect(within(details).getByText('0.625')).toBeTruthy();
});

it('runs SQL by Ctrl+Enter and shows what the server says of it', async () => {
  open('?view=sql');
  const box = await screen.findByLabelText('Query');
  fireEvent.change(box, { target: { value: 'DROP TABLE result' } });
  fireEvent.keyDown(box, { key: 'Enter', ctrlKey: true });
  expect((await screen.findByRole('alert')).textContent).toContain('SQL: only a SELECT is allowed');

  fireEvent.change(box, { target: { value: 'SELECT 1' } });
  fireEvent.change(screen.getByLabelText('Most rows'), { target: { value: '1' } });
  fireEvent.keyDown(box, { key: 'Enter', ctrlKey: true });
  const answer = await screen.findByRole('table', { name: 'Answer' });
  expect(within(answer).getAllByRole('cell').map((cell) => cell.textContent)).toEqual(['5', 'ü']);
  expect(screen.getByText(/There are more rows/)).toBeTruthy();
  expect(asked.queries.at(-1)).toMatchObject({ maxRows: 1, timeout: { seconds: 5n } });
});
