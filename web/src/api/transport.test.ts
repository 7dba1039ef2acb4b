import { Code, ConnectError, type HandlerContext } from '@connectrpc/connect';
import { beforeEach, describe, expect, it, vi } from 'vitest';
import { Role, SessionService } from '../gen/visionserver/v1/session_pb';
import { SequenceService } from '../gen/visionserver/v1/sequence_pb';
import { ErrorDetailSchema } from '../gen/visionserver/v1/error_pb';
import { freshTab, logIn, serve } from '../test/fakeServer';
import { api } from './clients';
import { useSession } from './session';

vi.mock('@connectrpc/connect-web', async () => (await import('../test/fakeServer')).connectWeb);

let valid = '';
let calls: (string | null)[] = [];

function check(context: HandlerContext) {
  const header = context.requestHeader.get('authorization');
  calls.push(header);
  if (header !== `Bearer ${valid}`) throw new ConnectError('log in first', Code.Unauthenticated);
}

const expired = () => vi.waitFor(() => expect(useSession.getState().expired).toBe(true));

beforeEach(() => {
  freshTab();
  calls = [];
  valid = 'first';
  serve(({ service }) => {
    service(SequenceService, {
      startSequence: ({ id }, context) => {
        check(context);
        return { sequence: id };
      },
      // eslint-disable-next-line @typescript-eslint/require-await
      async *watchSequence({ id }, context) {
        yield { sequence: id };
        check(context);
      },
    });
    service(SessionService, {
      login: () => {
        throw new ConnectError('user name or password is wrong', Code.Unauthenticated);
      },
    });
  });
});

describe('a call', () => {
  it('carries the token', async () => {
    logIn('anna', Role.OPERATOR, 'first');
    await api.sequences.startSequence({ id: 'depth' });
    expect(calls).toEqual(['Bearer first']);
  });

  it('that is refused because the session has ended is repeated after the next login', async () => {
    logIn('anna', Role.OPERATOR, 'first');
    valid = 'second';
    const answer = api.sequences.startSequence({ id: 'depth' });
    await expired();
    logIn('anna', Role.OPERATOR, 'second');
    expect((await answer).sequence).toBe('depth');
    expect(calls).toEqual(['Bearer first', 'Bearer second']);
  });

  it('waits again when the new session is refused, too', async () => {
    logIn('anna', Role.OPERATOR, 'first');
    valid = 'third';
    const answer = api.sequences.startSequence({ id: 'depth' });
    await expired();
    logIn('anna', Role.OPERATOR, 'second');
    await expired();
    logIn('anna', Role.OPERATOR, 'third');
    expect((await answer).sequence).toBe('depth');
  });

  it('is not repeated in the name of somebody else', async () => {
    logIn('anna', Role.OPERATOR, 'first');
    valid = 'of bert';
    const answer = api.sequences.startSequence({ id: 'depth' });
    const failed = expect(answer).rejects.toMatchObject({ code: Code.Unauthenticated });
    await expired();
    logIn('bert', Role.ADMIN, 'of bert');
    await failed;
    expect(calls).toHaveLength(1);
  });

  it('fails when the user leaves instead', async () => {
    logIn('anna', Role.OPERATOR, 'first');
    valid = 'second';
    const answer = api.sequences.startSequence({ id: 'depth' });
    const failed = expect(answer).rejects.toMatchObject({ code: Code.Unauthenticated });
    await expired();
    useSession.getState().clear();
    await failed;
  });

  it('stops waiting when its page is gone', async () => {
    logIn('anna', Role.OPERATOR, 'first');
    valid = 'second';
    const gone = new AbortController();
    const answer = api.sequences.startSequence({ id: 'depth' }, { signal: gone.signal });
    const failed = expect(answer).rejects.toMatchObject({ code: Code.Canceled });
    await expired();
    gone.abort();
    await failed;
  });
});

it('a wrong password is an error of the form, not the end of a session', async () => {
  logIn('anna', Role.OPERATOR, 'first');
  await expect(api.sessions.login({ user: 'anna', password: 'x' })).rejects.toThrow('wrong');
  expect(useSession.getState().expired).toBe(false);
});

it('a stream that breaks because the session has ended says so to the session', async () => {
  logIn('anna', Role.OPERATOR, 'first');
  valid = 'second';
  const seen: string[] = [];
  const watch = async () => {
    for await (const state of api.sequences.watchSequence({ id: 'depth' }))
      seen.push(state.sequence);
  };
  await expect(watch()).rejects.toMatchObject({ code: Code.Unauthenticated });
  expect(seen).toEqual(['depth']);
  expect(useSession.getState().expired).toBe(true);
});

it('a password that was reset meanwhile is asked for anew', async () => {
  serve(({ service }) =>
    service(SequenceService, {
      startSequence: () => {
        throw new ConnectError('change it first', Code.PermissionDenied, undefined, [
          { desc: ErrorDetailSchema, value: { reason: 'PASSWORD_CHANGE_REQUIRED' } },
        ]);
      },
    }),
  );
  logIn('anna', Role.OPERATOR, 'first');
  await expect(api.sequences.startSequence({ id: 'depth' })).rejects.toThrow('change it first');
  expect(useSession.getState().login?.mustChangePassword).toBe(true);
});
