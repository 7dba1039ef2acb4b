import { beforeEach, describe, expect, it, vi } from 'vitest';
import { Role } from '../gen/visionserver/v1/session_pb';
import { isAdmin, type Login, mayEngineer, mayOperate, useSession } from './session';

const anna: Login = {
  token: 'secret',
  user: 'anna',
  role: Role.OPERATOR,
  sessionId: 's1',
  mustChangePassword: false,
};

beforeEach(() => useSession.getState().clear());

describe('the session of a tab', () => {
  it('survives a reload', async () => {
    useSession.getState().setLogin(anna);
    vi.resetModules(); // what a reload does
    const reloaded = await import('./session');
    expect(reloaded.useSession.getState().login).toEqual(anna);
  });

  it('begins anew where what was stored cannot be read', async () => {
    sessionStorage.setItem('visionserver.session', '{"token": "sec');
    vi.resetModules();
    const reloaded = await import('./session');
    expect(reloaded.useSession.getState().login).toBeNull();
    expect(sessionStorage.getItem('visionserver.session')).toBeNull();
  });

  it('keeps who it was when it has expired, until the next login', () => {
    useSession.getState().setLogin(anna);
    useSession.getState().setExpired();
    expect(useSession.getState()).toMatchObject({ login: anna, expired: true });
    useSession.getState().setLogin({ ...anna, token: 'newer' });
    expect(useSession.getState().expired).toBe(false);
  });

  it('cannot expire when nobody is logged in', () => {
    useSession.getState().setExpired();
    expect(useSession.getState().expired).toBe(false);
  });

  it('leaves nothing behind after a logout', () => {
    useSession.getState().setLogin(anna);
    useSession.getState().clear();
    expect(useSession.getState().login).toBeNull();
    expect(sessionStorage.length).toBe(0);
  });
});

describe.each([
  { role: Role.UNSPECIFIED, operate: false, engineer: false, admin: false },
  { role: Role.VIEWER, operate: false, engineer: false, admin: false },
  { role: Role.ROBOT, operate: false, engineer: false, admin: false },
  { role: Role.OPERATOR, operate: true, engineer: false, admin: false },
  { role: Role.ENGINEER, operate: true, engineer: true, admin: false },
  { role: Role.ADMIN, operate: true, engineer: true, admin: true },
])('role $role', ({ role, operate, engineer, admin }) => {
  it('sees what it may use', () => {
    expect([mayOperate(role), mayEngineer(role), isAdmin(role)]).toEqual([
      operate,
      engineer,
      admin,
    ]);
  });
});
