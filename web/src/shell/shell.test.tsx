import { Code, ConnectError, type HandlerContext } from '@connectrpc/connect';
import { screen, waitFor, within } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it, vi } from 'vitest';
import { useSession } from '../api/session';
import { CameraService } from '../gen/visionserver/v1/camera_pb';
import { SequenceRunState, SequenceService } from '../gen/visionserver/v1/sequence_pb';
import { Role, SessionService } from '../gen/visionserver/v1/session_pb';
import { SystemService } from '../gen/visionserver/v1/system_pb';
import { freshTab, logIn, serve } from '../test/fakeServer';
import { renderPage } from '../test/renderPage';
import { setLanguage } from '../i18n';

vi.mock('@connectrpc/connect-web', async () => (await import('../test/fakeServer')).connectWeb);

let tokens: Record<string, { user: string; role: Role }>;
let password: string;
let mustChange: boolean;
let started: string[];

function caller(context: HandlerContext) {
  const token = context.requestHeader.get('authorization')?.replace('Bearer ', '') ?? '';
  const found = tokens[token];
  if (!found) throw new ConnectError('the session has ended; log in again', Code.Unauthenticated);
  return found;
}

beforeEach(async () => {
  freshTab();
  await setLanguage('en');
  tokens = { 'token of otto': { user: 'otto', role: Role.OPERATOR } };
  password = 'one-time';
  mustChange = true;
  started = [];
  serve(({ service }) => {
    service(SystemService, {
      getServerInfo: () => ({ name: 'cell 7' }),
      listAlarms: () => ({ alarms: [{ id: 'camera/left', message: 'no picture; see its cable' }] }),
      getResources: () => ({
        cpuCores: 2,
        load1min: 0.5,
        diskTotalBytes: 100n,
        diskFreeBytes: 40n,
      }),
      getStatistics: () => ({ usersOnline: ['anna', 'otto'] }),
    });
    service(SessionService, {
      login: (request) => {
        if (request.password !== password) {
          throw new ConnectError('user name or password is wrong', Code.Unauthenticated);
        }
        tokens['new token'] = { user: request.user, role: Role.OPERATOR };
        return { token: 'new token', role: Role.OPERATOR, mustChangePassword: mustChange };
      },
      changePassword: ({ oldPassword, newPassword }) => {
        if (oldPassword !== password) throw new ConnectError('wrong', Code.PermissionDenied);
        if (newPassword.length < 10) {
          throw new ConnectError('the new password is too short', Code.InvalidArgument);
        }
        password = newPassword;
        return {};
      },
      whoAmI: (_request, context) => caller(context),
      logout: () => ({}),
    });
    service(SequenceService, {
      listSequences: () => ({
        sequences: [{ id: 'depth', runState: SequenceRunState.STOPPED }],
      }),
      startSequence: ({ id }, context) => {
        caller(context);
        started.push(id);
        return {};
      },
    });
    service(CameraService, {
      listCameras: () => ({
        cameras: [
          { id: 'left', lastError: 'no packets; is the cable in?', counters: { lost: 3n } },
        ],
      }),
    });
  });
});

const field = (name: string) => screen.findByLabelText(name);

describe('logging in', () => {
  it('changes the one-time password first, then shows what was asked for', async () => {
    const page = renderPage('/results');
    expect(page.path()).toBe('/login');
    await userEvent.type(await field('User'), 'otto');
    await userEvent.type(await field('Password'), 'one-time{Enter}');

    await userEvent.type(await field('New password'), 'short');
    await userEvent.type(await field('New password again'), 'short{Enter}');
    expect((await screen.findByRole('alert')).textContent).toContain(
      'the new password is too short',
    );

    await userEvent.clear(await field('New password'));
    await userEvent.type(await field('New password'), 'a much longer one');
    await userEvent.clear(await field('New password again'));
    await userEvent.type(await field('New password again'), 'a much longer one{Enter}');
    await waitFor(() => expect(page.path()).toBe('/results'));
    expect(password).toBe('a much longer one');
  });

  it('asks for the same new password twice', async () => {
    renderPage('/');
    await userEvent.type(await field('User'), 'otto');
    await userEvent.type(await field('Password'), 'one-time{Enter}');
    await userEvent.type(await field('New password'), 'a much longer one');
    await userEvent.type(await field('New password again'), 'another long one{Enter}');
    expect(screen.getByText('This is not the same as above.')).toBeTruthy();
    expect(password).toBe('one-time');
  });

  it('says what the server says of a wrong password', async () => {
    renderPage('/');
    await userEvent.type(await field('User'), 'otto');
    await userEvent.type(await field('Password'), 'guess{Enter}');
    const alert = await screen.findByRole('alert');
    expect(alert.textContent).toContain('Login refused');
    expect(alert.textContent).toContain('user name or password is wrong');
  });

  it('goes to no other site afterwards', async () => {
    mustChange = false;
    const page = renderPage('/login?next=//evil.example/');
    await userEvent.type(await field('User'), 'otto');
    await userEvent.type(await field('Password'), 'one-time{Enter}');
    await waitFor(() => expect(page.path()).toBe('/'));
  });
});

describe('a session that has ended', () => {
  it('asks for the password over the page, and what was clicked happens', async () => {
    mustChange = false;
    logIn('otto', Role.OPERATOR);
    renderPage('/');
    const start = await screen.findByRole('button', { name: 'Start depth' });
    tokens = {};
    await userEvent.click(start);

    const dialog = await screen.findByRole('dialog', { name: 'Log in again' });
    expect(within(dialog).getByLabelText<HTMLInputElement>('User').value).toBe('otto');
    await userEvent.keyboard('{Escape}'); // does not get around it
    await userEvent.type(within(dialog).getByLabelText('Password'), 'one-time{Enter}');
    await waitFor(() => expect(started).toEqual(['depth']));
    await waitFor(() => expect(screen.queryByRole('dialog')).toBeNull());
  });

  it('lets one leave and log in as somebody else', async () => {
    logIn('otto', Role.OPERATOR, 'ended');
    const page = renderPage('/');
    await userEvent.click(await screen.findByRole('button', { name: /somebody else/ }));
    await waitFor(() => expect(page.path()).toBe('/login'));
    expect(useSession.getState().login).toBeNull();
  });
});

describe('what a role sees', () => {
  const open = async (role: Role, address = '/') => {
    tokens['token of otto'] = { user: 'otto', role };
    logIn('otto', role);
    const page = renderPage(address);
    await screen.findByRole('link', { name: 'depth' });
    return page;
  };

  it('viewer: everything, and nothing to change', async () => {
    await open(Role.VIEWER);
    expect(screen.queryByRole('button', { name: 'Start depth' })).toBeNull();
    expect(screen.queryByRole('link', { name: 'Users' })).toBeNull();
    expect(screen.queryByRole('link', { name: 'Audit' })).toBeNull();
  });

  it('operator: starts and stops', async () => {
    await open(Role.OPERATOR);
    await userEvent.click(screen.getByRole('button', { name: 'Start depth' }));
    await waitFor(() => expect(started).toEqual(['depth']));
  });

  it('operator: is led away from pages of administrators', async () => {
    const page = await open(Role.OPERATOR, '/users');
    expect(page.path()).toBe('/');
  });

  it('administrator: users and audit', async () => {
    await open(Role.ADMIN);
    expect(screen.getByRole('link', { name: 'Users' })).toBeTruthy();
    expect(screen.getByRole('link', { name: 'Audit' })).toBeTruthy();
  });

  it('follows when an administrator changes the role', async () => {
    tokens['token of otto'] = { user: 'otto', role: Role.VIEWER };
    logIn('otto', Role.OPERATOR);
    useSession.setState((state) => ({ login: state.login && { ...state.login, sessionId: '' } }));
    renderPage('/');
    await screen.findByRole('link', { name: 'depth' });
    await waitFor(() => expect(screen.queryByRole('button', { name: 'Start depth' })).toBeNull());
  });
});

describe('the overview', () => {
  it('tells cameras and alarms in the words of the server', async () => {
    logIn('otto', Role.OPERATOR);
    renderPage('/');
    expect(await screen.findByText('no packets; is the cable in?')).toBeTruthy();
    expect(await screen.findByText(/no picture; see its cable/)).toBeTruthy();
    expect(await screen.findByText('anna, otto')).toBeTruthy();
    expect(document.title).toBe('Overview · cell 7 · VisionServer');
  });

  it('speaks German when asked, and says so to screen readers', async () => {
    logIn('otto', Role.OPERATOR);
    renderPage('/');
    await userEvent.click(await screen.findByRole('radio', { name: /Deutsch/ }));
    expect(await screen.findByRole('heading', { name: 'Sequenzen' })).toBeTruthy();
    expect(document.documentElement.lang).toBe('de');
    expect(localStorage.getItem('visionserver.language')).toBe('de');
  });
});
