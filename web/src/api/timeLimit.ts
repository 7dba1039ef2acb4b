import type { DescMethod } from '@bufbuild/protobuf';
import {
  Code,
  ConnectError,
  createContextKey,
  createContextValues,
  type Interceptor,
  type Transport,
} from '@connectrpc/connect';

const kLimitMs = 10_000;
// Passwords are slow to check by design, statements run up to 30 s, files are large, and a start or
// stop waits for cameras.
const kLongLimitMs = 60_000;
const kLongCalls = new Set([
  'ChangePassword',
  'GetResultFile',
  'ListResults',
  'Login',
  'QueryResults',
  'StartSequence',
  'StopSequence',
]);

/** Milliseconds, where the caller says nothing else. */
function timeLimitMs(method: DescMethod): number {
  return kLongCalls.has(method.name) ? kLongLimitMs : kLimitMs;
}

const limitKey = createContextKey<number | undefined>(undefined);

/**
 * Hands the time limit of unary calls (`timeoutMs`) to `withTimeLimit`: Connect's own runs from the
 * first attempt, also while the user types a password between two of them. Streams have no limit.
 */
export function withoutDeadline(transport: Transport): Transport {
  return {
    unary: (method, signal, timeoutMs, header, input, values = createContextValues()) =>
      transport.unary(method, signal, undefined, header, input, values.set(limitKey, timeoutMs)),
    stream: (...call) => transport.stream(...call),
  };
}

/** Ends each attempt of a unary call that has no answer within the call's time limit. */
export const withTimeLimit: Interceptor = (next) => async (request) => {
  if (request.stream) return next(request);
  const { method } = request;
  const limitMs = request.contextValues.get(limitKey) ?? timeLimitMs(method);
  const stop = new AbortController();
  const leave = () => stop.abort(request.signal.reason);
  request.signal.addEventListener('abort', leave);
  const timer = setTimeout(() => {
    const found = `${method.name} had no answer within ${limitMs / 1000} s`;
    const remedy = 'see whether the server runs and can be reached, then try again';
    stop.abort(new ConnectError(`${found}; ${remedy}`, Code.DeadlineExceeded));
  }, limitMs);
  try {
    request.signal.throwIfAborted();
    request.header.set('grpc-timeout', `${limitMs}m`);
    return await next({ ...request, signal: stop.signal });
  } catch (error) {
    throw stop.signal.aborted ? stop.signal.reason : error;
  } finally {
    clearTimeout(timer);
    request.signal.removeEventListener('abort', leave);
  }
};
