import { Code, ConnectError } from '@connectrpc/connect';
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { noteFailure, setProbe, useConnection } from './connection';
import { keepStreaming } from './keepStreaming';
import { useSession } from './session';

const gone = () => ConnectError.from(new TypeError('Failed to fetch'));

beforeEach(() => {
  vi.useFakeTimers();
  useConnection.setState({ lost: false, recoveries: 0 });
  useSession.getState().clear();
});
afterEach(() => vi.useRealTimers());

describe('a lost connection', () => {
  it('is asked for with growing waits, by one prober, until the server answers', async () => {
    const times: number[] = [];
    const start = Date.now();
    setProbe(() => {
      times.push(Date.now() - start);
      return times.length < 6 ? Promise.reject(gone()) : Promise.resolve();
    });
    noteFailure(gone());
    noteFailure(gone());
    expect(useConnection.getState().lost).toBe(true);
    await vi.advanceTimersByTimeAsync(60_000);
    expect(times).toEqual([500, 1500, 3500, 7500, 12_500, 17_500]);
    expect(useConnection.getState()).toEqual({ lost: false, recoveries: 1 });
  });

  it('is seen in what fetch() throws, as interceptors get it', () => {
    setProbe(() => Promise.resolve());
    noteFailure(new TypeError('Failed to fetch'));
    expect(useConnection.getState().lost).toBe(true);
  });

  it('is found again by an answer that is an error', async () => {
    setProbe(() => Promise.reject(new ConnectError('busy', Code.ResourceExhausted)));
    noteFailure(gone());
    await vi.advanceTimersByTimeAsync(500);
    expect(useConnection.getState().lost).toBe(false);
  });

  it('is not what the server says about something else', () => {
    noteFailure(new ConnectError('no such sequence', Code.NotFound));
    expect(useConnection.getState().lost).toBe(false);
  });
});

describe('a kept stream', () => {
  /** Opens one after the other; each yields what stands there, an error is thrown. */
  function streams(...all: (number | Error)[][]) {
    let opened = 0;
    return {
      opened: () => opened,
      // eslint-disable-next-line @typescript-eslint/require-await
      open: async function* (this: void) {
        for (const item of all[opened++] ?? []) {
          if (item instanceof Error) throw item;
          yield item;
        }
      },
    };
  }

  async function collect(source: AsyncIterable<number>, into: number[]) {
    for await (const item of source) into.push(item);
  }

  it('goes on by itself once the server answers again', async () => {
    let answers = false;
    setProbe(() => (answers ? Promise.resolve() : Promise.reject(gone())));
    const source = streams([1, 2, gone()], [3]);
    const stop = new AbortController();
    const seen: number[] = [];
    const breaks: unknown[] = [];
    const done = collect(
      keepStreaming(source.open, stop.signal, (error) => {
        breaks.push(error);
        noteFailure(error);
      }),
      seen,
    ).catch(() => {});
    await vi.advanceTimersByTimeAsync(20_000);
    expect([seen, source.opened()]).toEqual([[1, 2], 1]);
    answers = true;
    await vi.advanceTimersByTimeAsync(6_000);
    expect(seen).toEqual([1, 2, 3]);
    expect(breaks[0]).toBeInstanceOf(ConnectError);
    stop.abort();
    await done;
  });

  it('waits for the next login when the session has ended', async () => {
    const login = { token: 'a', user: 'anna', role: 1, sessionId: 's', mustChangePassword: false };
    useSession.getState().setLogin(login);
    const ended = new ConnectError('the session has ended', Code.Unauthenticated);
    const source = streams([1, ended], [2]);
    const stop = new AbortController();
    const seen: number[] = [];
    const done = collect(
      keepStreaming(source.open, stop.signal, () => useSession.getState().setExpired()),
      seen,
    ).catch(() => {});
    await vi.advanceTimersByTimeAsync(60_000);
    expect(source.opened()).toBe(1);
    useSession.getState().setLogin({ ...login, token: 'b' });
    await vi.advanceTimersByTimeAsync(500);
    expect(seen).toEqual([1, 2]);
    stop.abort();
    await done;
  });

  it('ends when nobody wants it any more', async () => {
    const stop = new AbortController();
    const done = collect(keepStreaming(streams([1]).open, stop.signal), []);
    const failed = expect(done).rejects.toBe('left');
    await vi.advanceTimersByTimeAsync(100);
    stop.abort('left');
    await failed;
  });
});
