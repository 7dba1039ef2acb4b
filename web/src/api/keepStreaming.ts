import { useConnection } from './connection';
import { isConnectionLost, isUnauthenticated } from './errors';
import { useSession } from './session';
import { sleep, until } from './wait';

const kFirstWaitMs = 500;
const kLongestWaitMs = 5000;

/**
 * Messages of a stream that is opened again whenever it ends: after a lost connection as soon as the
 * server answers, after the end of the session once the user has logged in again, and after any
 * other error with growing waits. Ends only by throwing, when `signal` is aborted or nobody is
 * logged in any more. `onBreak` hears of each end.
 */
export async function* keepStreaming<Message>(
  open: () => AsyncIterable<Message>,
  signal: AbortSignal,
  onBreak: (error: unknown) => void = () => {},
): AsyncGenerator<Message> {
  let waitMs = kFirstWaitMs;
  for (;;) {
    let failure: unknown;
    try {
      for await (const message of open()) {
        waitMs = kFirstWaitMs;
        yield message;
      }
    } catch (error) {
      signal.throwIfAborted();
      failure = error;
    }
    onBreak(failure);
    if (isUnauthenticated(failure)) {
      await until(useSession, (state) => !state.expired, signal);
      if (!useSession.getState().login) throw failure;
    } else if (isConnectionLost(failure)) {
      await until(useConnection, (state) => !state.lost, signal);
    }
    await sleep(waitMs, signal);
    waitMs = Math.min(2 * waitMs, kLongestWaitMs);
  }
}
