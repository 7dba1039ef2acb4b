import { Code, ConnectError, type HandlerContext } from '@connectrpc/connect';
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { ParameterService } from '../gen/visionserver/v1/parameter_pb';
import { ResultService } from '../gen/visionserver/v1/result_pb';
import { Role, SessionService } from '../gen/visionserver/v1/session_pb';
import { SequenceService } from '../gen/visionserver/v1/sequence_pb';
import { ErrorDetailSchema } from '../gen/visionserver/v1/error_pb';
import { freshTab, logIn, serve } from '../test/fakeServer';
import { api } from './clients';
import { pageApi } from './pageClients';
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

describe('the time limit', () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => vi.useRealTimers());

  it('of a call does not run while the user logs in again', async () => {
    const set: string[] = [];
    serve(({ service }) =>
      service(ParameterService, {
        setParameters: ({ values }, context) => {
          check(context);
          set.push(...values.map(({ path }) => path));
          return {};
        },
      }),
    );
    logIn('anna', Role.OPERATOR, 'first');
    valid = 'second';
    const change = { sequence: 'depth', values: [{ path: 'match.p1' }] };
    const answer = api.parameters.setParameters(change, { timeoutMs: 10_000 });
    await expired();
    await vi.advanceTimersByTimeAsync(15_000); // of the dialog
    expect(set).toEqual([]);
    logIn('anna', Role.OPERATOR, 'second');
    await answer;
    expect(set).toEqual(['match.p1']);
  });

  it('ends each attempt when the server has vanished, after longer where it may work longer', async () => {
    const never = () => new Promise<never>(() => {});
    serve(({ service }) => {
      service(SequenceService, { getSequence: never });
      service(ResultService, { queryResults: never });
    });
    logIn('anna', Role.OPERATOR);
    const ended: string[] = [];
    const note = (error: unknown) => {
      expect(error).toMatchObject({ code: Code.DeadlineExceeded });
      ended.push((error as ConnectError).rawMessage);
    };
    const calls = [
      api.sequences.getSequence({ id: 'depth' }).catch(note),
      api.sequences.getSequence({ id: 'depth' }, { timeoutMs: 3000 }).catch(note),
      pageApi.results.queryResults({ sql: 'SELECT 1' }).catch(note),
    ];
    await vi.advanceTimersByTimeAsync(3000);
    expect(ended).toEqual([expect.stringContaining('GetSequence had no answer within 3 s')]);
    await vi.advanceTimersByTimeAsync(7000);
    expect(ended.slice(1)).toEqual([expect.stringContaining('within 10 s')]);
    await vi.advanceTimersByTimeAsync(49_000);
    expect(ended).toHaveLength(2);
    await vi.advanceTimersByTimeAsync(1000);
    expect(ended.slice(2)).toEqual([expect.stringContaining('QueryResults had no answer within 60 s')]);
    await Promise.all(calls);
  });

  it('is told to the server', async () => {
    let told: string | null = null;
    serve(({ service }) =>
      service(SequenceService, {
        startSequence: (_, { requestHeader }) => {
          told = requestHeader.get('grpc-timeout');
          return {};
        },
      }),
    );
    await api.sequences.startSequence({ id: 'depth' });
    expect(told).toBe('60000m');
  });

  it('does not end a stream', async () => {
    let opened: AbortSignal | undefined;
    serve(({ service }) =>
      service(SequenceService, {
        async *watchSequence({ id }, { signal }) {
          opened = signal;
          yield { sequence: id };
          await new Promise<never>(() => {});
        },
      }),
    );
    const left = new AbortController();
    const watch = async () => {
      const states = api.sequences.watchSequence({ id: 'depth' }, { signal: left.signal });
      for await (const state of states) expect(state.sequence).toBe('depth');
    };
    const watching = expect(watch()).rejects.toMatchObject({ code: Code.Canceled });
    await vi.advanceTimersByTimeAsync(24 * 3600_000);
    expect(opened?.aborted).toBe(false);
    left.abort();
    await watching;
  });
});
