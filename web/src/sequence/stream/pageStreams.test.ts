import { Code, ConnectError } from '@connectrpc/connect';
import { afterEach, beforeEach, expect, it, vi } from 'vitest';
import { useSession } from '../../api/session';
import { Role } from '../../gen/visionserver/v1/session_pb';
import { StreamService } from '../../gen/visionserver/v1/stream_pb';
import { SystemService } from '../../gen/visionserver/v1/system_pb';
import { freshTab, logIn, serve } from '../../test/fakeServer';
import type { Subscribed } from './multiplexer';
import { multiplexer } from './pageStreams';

vi.mock('@connectrpc/connect-web', async () => (await import('../../test/fakeServer')).connectWeb);

const gone = () => new ConnectError('HTTP 503', Code.Unavailable);

let answers = true;
let valid = '';
let opened = 0;
let clockQuestions = 0;
let breakStream: (error: ConnectError) => void = () => {};
let watched: Subscribed;

function show(visibility: 'visible' | 'hidden') {
  vi.spyOn(document, 'visibilityState', 'get').mockReturnValue(visibility);
  document.dispatchEvent(new Event('visibilitychange'));
}

beforeEach(async () => {
  vi.useFakeTimers();
  freshTab();
  answers = true;
  opened = clockQuestions = 0;
  serve(({ service }) => {
    service(StreamService, {
      async *subscribe(_, { requestHeader, signal }) {
        if (!answers) throw gone();
        if (requestHeader.get('authorization') !== `Bearer ${valid}`) {
          throw new ConnectError('log in first', Code.Unauthenticated);
        }
        yield { streamId: `stream ${++opened}` };
        await new Promise<never>((_resolve, reject) => {
          breakStream = reject;
          signal.addEventListener('abort', () => reject(ConnectError.from(signal.reason)));
        });
      },
      updateSubscriptions: () => ({}),
    });
    service(SystemService, {
      getServerInfo: () => {
        if (!answers) throw gone();
        ++clockQuestions;
        return { monotonicNs: 1n };
      },
    });
  });
  valid = 'first';
  logIn('anna', Role.VIEWER, 'first');
  watched?.end();
  watched = multiplexer.subscribe(
    { stream: 'depth/match.disparity' },
    { onItem: () => {}, onNotice: () => {} },
  );
  await vi.advanceTimersByTimeAsync(100);
  expect(opened).toBe(1);
});

afterEach(async () => {
  watched.end();
  await vi.advanceTimersByTimeAsync(100);
  vi.restoreAllMocks();
  vi.useRealTimers();
});

it('the stream of a tab goes on by itself once the server answers again', async () => {
  answers = false;
  breakStream(gone());
  await vi.advanceTimersByTimeAsync(20_000);
  expect(opened).toBe(1);
  answers = true;
  await vi.advanceTimersByTimeAsync(6000);
  expect(opened).toBeGreaterThan(1);
  expect(multiplexer.connection).toBe('open');
});

it('the stream of a tab waits for the next login when the session has ended', async () => {
  valid = 'second';
  breakStream(new ConnectError('the session has ended', Code.Unauthenticated));
  await vi.advanceTimersByTimeAsync(60_000);
  expect(useSession.getState().expired).toBe(true);
  expect(opened).toBe(1);
  logIn('anna', Role.VIEWER, 'second');
  await vi.advanceTimersByTimeAsync(500);
  expect(opened).toBe(2);
});

it('the clock is asked every minute while the stream is open', async () => {
  const before = clockQuestions;
  expect(before).toBeGreaterThan(0);
  await vi.advanceTimersByTimeAsync(60_000);
  expect(clockQuestions).toBe(2 * before);
  await vi.advanceTimersByTimeAsync(120_000);
  expect(clockQuestions).toBe(4 * before);
});

it.each([
  ['nobody sees it', () => show('hidden')],
  ['the user has logged out', () => useSession.getState().clear()],
  ['nothing is watched any more', () => watched.end()],
])('neither stream nor clock is asked for when %s', async (_when, leave) => {
  leave();
  await vi.advanceTimersByTimeAsync(100);
  const before = clockQuestions;
  await vi.advanceTimersByTimeAsync(600_000);
  expect([opened, clockQuestions]).toEqual([1, before]);
});

it('stream and clock go on when the tab is seen again', async () => {
  show('hidden');
  await vi.advanceTimersByTimeAsync(100);
  const before = clockQuestions;
  show('visible');
  await vi.advanceTimersByTimeAsync(100);
  expect(opened).toBe(2);
  expect(clockQuestions).toBe(2 * before);
});
