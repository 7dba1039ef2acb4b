import { isUnauthenticated } from './errors';
import { useSession } from './session';
import { until } from './wait';

/**
 * Does `work`, and does it again from its beginning when it failed because the session has ended and
 * its user has logged in again, so a page loses nothing. Fails as `work` does when the user logs out
 * instead or somebody else logs in, and with the signal's reason when that is aborted while waiting.
 */
export async function acrossLogins<T>(work: () => Promise<T>, signal?: AbortSignal): Promise<T> {
  for (;;) {
    const login = useSession.getState().login;
    try {
      return await work();
    } catch (error) {
      if (!login || !isUnauthenticated(error)) throw error;
      await until(useSession, (state) => state.login?.token !== login.token, signal);
      if (useSession.getState().login?.user !== login.user) throw error;
    }
  }
}
