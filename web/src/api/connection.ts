import { ConnectError } from '@connectrpc/connect';
import { create } from 'zustand';
import { isConnectionLost } from './errors';
import { sleep } from './wait';

const kFirstWaitMs = 500;
const kLongestWaitMs = 5000;

interface ConnectionState {
  /** A call got no answer, and none has since. */
  lost: boolean;
  /** How often it was found again; what was open before may want to be opened anew. */
  recoveries: number;
}

/** Whether the server answers. One prober asks for all pages while it does not. */
export const useConnection = create<ConnectionState>()(() => ({ lost: false, recoveries: 0 }));

let probe: (() => Promise<unknown>) | undefined;

/** Says how to find out whether the server answers: any cheap call that needs no login. */
export function setProbe(call: () => Promise<unknown>): void {
  probe = call;
}

async function probeUntilAnswered(): Promise<void> {
  for (let waitMs = kFirstWaitMs; ; waitMs = Math.min(2 * waitMs, kLongestWaitMs)) {
    await sleep(waitMs);
    try {
      await probe?.();
      break;
    } catch (error) {
      if (!isConnectionLost(error)) break; // an error is an answer, too
    }
  }
  useConnection.setState((state) => ({ lost: false, recoveries: state.recoveries + 1 }));
}

/**
 * Told by the transport of every call that failed. Interceptors see what fetch() throws as it is;
 * Connect makes its own error of it later.
 */
export function noteFailure(error: unknown): void {
  if (!isConnectionLost(ConnectError.from(error)) || useConnection.getState().lost) return;
  useConnection.setState({ lost: true });
  void probeUntilAnswered();
}
