import type { Interceptor, StreamResponse } from '@connectrpc/connect';
import { createGrpcWebTransport } from '@connectrpc/connect-web';
import { acrossLogins } from './acrossLogins';
import { noteFailure } from './connection';
import { isUnauthenticated, reasonOf } from './errors';
import { useSession } from './session';
import { withoutDeadline, withTimeLimit } from './timeLimit';

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

type Call = Parameters<ReturnType<Interceptor>>[0];
type Answer = ReturnType<ReturnType<Interceptor>>;

async function callOnce(next: (call: Call) => Answer, call: Call): Answer {
  const token = useSession.getState().login?.token;
  if (token) call.header.set('authorization', `Bearer ${token}`);
  try {
    const response = await next(call);
    return response.stream ? { ...response, message: noted(response.message, token) } : response;
  } catch (error) {
    note(error, token);
    throw error;
  }
}

/**
 * Gives each call the token. A unary call that is refused because the session has ended is repeated
 * after the next login; each attempt has the call's whole time limit. A stream fails; who opened it
 * opens it again.
 */
export const withSession: Interceptor = (next) => async (call) => {
  if (call.method.name === 'Login') {
    return next(call).catch((error: unknown) => {
      noteFailure(error);
      throw error;
    });
  }
  if (call.stream) return callOnce(next, call);
  return acrossLogins(() => callOnce(next, call), call.signal);
};

const base = { baseUrl: window.location.origin };

/** All calls go to the page's own origin, as gRPC-Web in its binary form. */
export const transport = withoutDeadline(
  createGrpcWebTransport({ ...base, interceptors: [withSession, withTimeLimit] }),
);

/** Without token and without telling anybody of failures. */
export const bareTransport = createGrpcWebTransport(base);
