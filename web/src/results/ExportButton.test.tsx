import { Code, ConnectError } from '@connectrpc/connect';
import { MantineProvider } from '@mantine/core';
import { render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, expect, it, vi } from 'vitest';

import { useSession } from '../api/session';
import { ResultService } from '../gen/visionserver/v1/result_pb';
import { Role } from '../gen/visionserver/v1/session_pb';
import { download } from '../shell/download';
import { freshTab, logIn, serve } from '../test/fakeServer';
import { ExportButton } from './ExportButton';
import { everything } from './filter';

vi.mock('@connectrpc/connect-web', async () => (await import('../test/fakeServer')).connectWeb);
vi.mock('../shell/download', () => ({ download: vi.fn() }));

const saved = vi.mocked(download);
const bytes = (text: string) => new TextEncoder().encode(text);
let begins: (bigint | undefined)[];

beforeEach(async () => {
  freshTab();
  saved.mockClear();
  begins = [];
  serve(({ service }) =>
    service(ResultService, {
      // eslint-disable-next-line @typescript-eslint/require-await
      async *exportResults({ filter }, { requestHeader }) {
        begins.push(filter?.from?.seconds);
        yield { data: bytes('number\r\n') };
        if (requestHeader.get('authorization') !== 'Bearer second') {
          throw new ConnectError('the session has ended; log in again', Code.Unauthenticated);
        }
        yield { data: bytes('1\r\n') };
      },
    }),
  );
  logIn('vera', Role.VIEWER, 'first');
  render(
    <MantineProvider env="test">
      <ExportButton selection={everything} />
    </MantineProvider>,
  );
  await userEvent.click(screen.getByRole('button', { name: 'Export as CSV' }));
  await vi.waitFor(() => expect(useSession.getState().expired).toBe(true));
});

it('an export during which the session ends begins again after the login, and is whole', async () => {
  expect(screen.getByRole('button', { name: 'Cancel' })).toBeTruthy();
  logIn('vera', Role.VIEWER, 'second');
  await screen.findByRole('button', { name: 'Export as CSV' });
  expect(screen.queryByRole('alert')).toBeNull();
  expect(saved).toHaveBeenCalledOnce();
  expect(await saved.mock.calls[0]![1].text()).toBe('number\r\n1\r\n');
  // Of the same results as at first.
  expect(begins).toHaveLength(2);
  expect(begins[1]).toBe(begins[0]);
});

it('an export that waits for a login can be cancelled', async () => {
  await userEvent.click(screen.getByRole('button', { name: 'Cancel' }));
  await screen.findByRole('button', { name: 'Export as CSV' });
  logIn('vera', Role.VIEWER, 'second');
  expect(saved).not.toHaveBeenCalled();
  expect(begins).toHaveLength(1);
});
