import type { Interceptor, StreamResponse } from '@connectrpc/connect';
import { createGrpcWebTransport } from '@connectrpc/connect-web';
import { noteFailure } from './connection';
import { isUnauthenticated, reasonOf } from './errors';
import { useSession } from './session';
import { withoutDeadline, withTimeLimit } from './timeLimit';
import { until } from './wait';

/** Tells session and connection what a failed call says about them; `token` is what it carried. */
function note(error: unknown, token: string | undefined): void {
  noteFailure(error);
  const session = useSession.getState();
  if (!token || token !== session.login?.token) return;
  if (isUnauthenticated(error)) session.setExpired();
  if (reasonOf(error) === 'PASSWORD_CHANGE_REQUIRED') {
    session.setLogin({ ...session.login, mustChangePassword: true });
  }
}

async function* noted(messages: StreamResponse['message'], token: string | undefined) {
  try {
    yield* messages;
  } catch (error) {
    note(error, token);
    throw error;
  }
}

/**
 * Gives each call the token. A unary call that is refused because the session has ended waits until
 * its user has logged in again, and is then repeated, so a page loses nothing; it fails when the user
 * logs out instead. Each attempt has the call's whole time limit. A stream fails; who opened it opens
 * it again (see `sequence/stream`).
 */
export const withSession: Interceptor = (next) => async (request) => {
  for (;;) {
    const login = useSession.getState().login;
    const isLogin = request.method.name === 'Login';
    if (login && !isLogin) request.header.set('authorization', `Bearer ${login.token}`);
    try {
      const response = await next(request);
      return response.stream
        ? { ...response, message: noted(response.message, login?.token) }
        : response;
    } catch (error) {
      if (isLogin) {
        noteFailure(error);
        throw error;
      }
      note(error, login?.token);
      if (request.stream || !login || !isUnauthenticated(error)) throw error;
      await until(useSession, (state) => state.login?.token !== login.token, request.signal);
      if (useSession.getState().login?.user !== login.user) throw error;
    }
  }
};

const base = { baseUrl: window.location.origin };

/** All calls go to the page's own origin, as gRPC-Web in its binary form. */
export const transport = withoutDeadline(
  createGrpcWebTransport({ ...base, interceptors: [withSession, withTimeLimit] }),
);

/** Without token and without telling anybody of failures. */
export const bareTransport = createGrpcWebTransport(base);
