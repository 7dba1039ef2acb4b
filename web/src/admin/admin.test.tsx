import { timestampFromMs } from '@bufbuild/protobuf/wkt';
import { Code, ConnectError } from '@connectrpc/connect';
import { screen, waitFor, within } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, expect, it, vi } from 'vitest';
import { AuditService, type ListAuditEntriesRequest } from '../gen/visionserver/v1/audit_pb';
import { Role, SessionService } from '../gen/visionserver/v1/session_pb';
import { SystemService } from '../gen/visionserver/v1/system_pb';
import { UserService } from '../gen/visionserver/v1/user_pb';
import { setLanguage } from '../i18n';
import { freshTab, logIn, serve } from '../test/fakeServer';
import { renderPage } from '../test/renderPage';

vi.mock('@connectrpc/connect-web', async () => (await import('../test/fakeServer')).connectWeb);

let calls: string[];
let asked: ListAuditEntriesRequest[];

beforeEach(async () => {
  freshTab();
  await setLanguage('en');
  calls = [];
  asked = [];
  logIn('admin', Role.ADMIN);
  serve(({ service }) => {
    service(SystemService, { getServerInfo: () => ({ name: 'cell 7' }) });
    service(SessionService, {
      whoAmI: () => ({ user: 'admin', role: Role.ADMIN }),
      revokeSession: ({ sessionId }) => {
        calls.push(`revoke ${sessionId}`);
        return {};
      },
    });
    service(UserService, {
      listUsers: () => ({
        users: [
          { name: 'admin', role: Role.ADMIN, etag: 'a1' },
          {
            name: 'otto',
            role: Role.OPERATOR,
            etag: 'o1',
            lockedUntil: timestampFromMs(Date.UTC(2026, 10, 22, 12, 0)),
          },
        ],
      }),
      createUser: ({ name, role }) => {
        if (name === 'Otto') {
          throw new ConnectError('"Otto" is not a user name: take a-z', Code.InvalidArgument);
        }
        calls.push(`create ${name} ${Role[role]}`);
        return { user: { name, role }, oneTimePassword: 'abcde-fghij' };
      },
      updateUser: ({ name, role, disabled, etag }) => {
        calls.push(`update ${name} ${role ? Role[role] : ''}${disabled ?? ''} ${etag}`);
        return {};
      },
      deleteUser: ({ name }) => {
        if (name === 'admin') {
          throw new ConnectError('admin is the last administrator', Code.FailedPrecondition);
        }
        calls.push(`delete ${name}`);
        return {};
      },
      unlockUser: ({ name }) => {
        calls.push(`unlock ${name}`);
        return {};
      },
      resetPassword: () => ({ oneTimePassword: 'new-one-time' }),
      listSessions: () => ({
        sessions: [
          { id: 's1', user: 'admin', role: Role.ADMIN, current: true },
          { id: 's2', user: 'otto', role: Role.OPERATOR, address: '10.0.0.7' },
        ],
      }),
      listApiKeys: () => ({ keys: [{ id: 'k1', name: 'robot cell 7', role: Role.ROBOT }] }),
      createApiKey: ({ name }) => ({ key: { name }, secret: 'vsk_secret' }),
      revokeApiKey: ({ id }) => {
        calls.push(`revoke ${id}`);
        return {};
      },
    });
    service(AuditService, {
      listAuditEntries: (request) => {
        asked.push(request);
        const first = request.pageToken === '';
        return {
          entries: [
            {
              number: first ? 2n : 1n,
              user: first ? 'otto' : 'admin',
              method: '/visionserver.v1.SequenceService/StartSequence',
              subject: 'depth',
              ok: !first,
              message: first ? 'the camera is gone' : '',
            },
          ],
          nextPageToken: first ? 'more' : '',
        };
      },
    });
  });
});

async function menuOf(name: string, item: string) {
  await userEvent.click(await screen.findByRole('button', { name: `Actions for ${name}` }));
  await userEvent.click(await screen.findByRole('menuitem', { name: item }));
}

it('a new user gets a one-time password that is shown once', async () => {
  renderPage('/users');
  await userEvent.click(await screen.findByRole('button', { name: 'New user' }));
  await userEvent.type(await screen.findByLabelText('Name'), 'berta');
  await userEvent.selectOptions(screen.getByLabelText('Role'), 'Engineer');
  await userEvent.click(screen.getByRole('button', { name: 'Create' }));
  expect(await screen.findByText('abcde-fghij')).toBeTruthy();
  expect(calls).toEqual(['create berta ENGINEER']);
  await userEvent.click(screen.getByRole('button', { name: 'Done' }));
  await waitFor(() => expect(screen.queryByText('abcde-fghij')).toBeNull());
});

it('a refused name stays in the form, with what the server says', async () => {
  renderPage('/users');
  await userEvent.click(await screen.findByRole('button', { name: 'New user' }));
  await userEvent.type(await screen.findByLabelText('Name'), 'Otto{Enter}');
  expect((await screen.findByRole('alert')).textContent).toContain('is not a user name');
  expect(screen.getByLabelText<HTMLInputElement>('Name').value).toBe('Otto');
});

it('a user is given a role, disabled and unlocked on what the table was read as', async () => {
  renderPage('/users');
  await userEvent.selectOptions(await screen.findByLabelText('Role of otto'), 'Viewer');
  await menuOf('otto', 'Disable');
  await menuOf('otto', 'Unlock');
  await waitFor(() => expect(calls).toHaveLength(3));
  expect(calls).toEqual(['update otto VIEWER o1', 'update otto true o1', 'unlock otto']);
});

it('deleting asks first, and Escape is no', async () => {
  renderPage('/users');
  await menuOf('otto', 'Delete');
  const dialog = await screen.findByRole('dialog', { name: 'Delete otto?' });
  const cancel = within(dialog).getByRole('button', { name: 'Cancel' });
  await waitFor(() => expect(document.activeElement).toBe(cancel));
  await userEvent.keyboard('{Escape}');
  await waitFor(() => expect(screen.queryByRole('dialog')).toBeNull());
  expect(calls).toEqual([]);

  await menuOf('otto', 'Delete');
  await userEvent.click(await screen.findByRole('button', { name: 'Delete' }));
  await waitFor(() => expect(calls).toEqual(['delete otto']));
});

it('what cannot be deleted says why in the dialog', async () => {
  renderPage('/users');
  await menuOf('admin', 'Delete');
  await userEvent.click(await screen.findByRole('button', { name: 'Delete' }));
  expect((await screen.findByRole('alert')).textContent).toContain('the last administrator');
});

it('a reset password is shown once', async () => {
  renderPage('/users');
  await menuOf('otto', 'Reset password');
  await userEvent.click(await screen.findByRole('button', { name: 'Reset password' }));
  expect(await screen.findByText('new-one-time')).toBeTruthy();
});

it('sessions of others can be ended, not the own one', async () => {
  renderPage('/users');
  await userEvent.click(await screen.findByRole('tab', { name: 'Sessions' }));
  await userEvent.click(await screen.findByRole('button', { name: 'End the session of otto' }));
  await waitFor(() => expect(calls).toEqual(['revoke s2']));
  expect(screen.queryByRole('button', { name: 'End the session of admin' })).toBeNull();
});

it('keys are made, shown once, and revoked after asking', async () => {
  renderPage('/users');
  await userEvent.click(await screen.findByRole('tab', { name: 'API keys' }));
  await userEvent.click(await screen.findByRole('button', { name: 'New key' }));
  await userEvent.type(await screen.findByLabelText('Name'), 'robot{Enter}');
  expect(await screen.findByText('vsk_secret')).toBeTruthy();
  await userEvent.click(screen.getByRole('button', { name: 'Done' }));
  await userEvent.click(await screen.findByRole('button', { name: 'Revoke robot cell 7' }));
  await userEvent.click(await screen.findByRole('button', { name: 'Revoke' }));
  await waitFor(() => expect(calls).toEqual(['revoke k1']));
});

it('the audit shows refusals with their reason, filters, and goes back in time', async () => {
  renderPage('/audit');
  expect(await screen.findByText('the camera is gone')).toBeTruthy();
  await userEvent.click(screen.getByRole('button', { name: 'Older entries' }));
  expect(await screen.findByText('done')).toBeTruthy();
  expect(asked.map((request) => request.pageToken)).toEqual(['', 'more']);
  await userEvent.type(screen.getByLabelText('User'), 'otto');
  await waitFor(() => expect(asked.at(-1)).toMatchObject({ user: 'otto', pageToken: '' }));
});
