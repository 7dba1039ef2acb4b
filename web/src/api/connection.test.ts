import { Code, ConnectError } from '@connectrpc/connect';
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { noteFailure, setProbe, useConnection } from './connection';

const gone = () => ConnectError.from(new TypeError('Failed to fetch'));

beforeEach(() => {
  vi.useFakeTimers();
  useConnection.setState({ lost: false, recoveries: 0 });
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
