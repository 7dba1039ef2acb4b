import { Code, ConnectError } from '@connectrpc/connect';
import { type ErrorDetail, ErrorDetailSchema } from '../gen/visionserver/v1/error_pb';

function detailOf(error: unknown): ErrorDetail | undefined {
  return ConnectError.from(error).findDetails(ErrorDetailSchema)[0];
}

/** The server's stable word for what went wrong, such as "PASSWORD_CHANGE_REQUIRED"; else empty. */
export function reasonOf(error: unknown): string {
  return detailOf(error)?.reason ?? '';
}

/** What the server says, as it says it: its texts name the thing, the value and the remedy. */
export function messageOf(error: unknown): string {
  const faults = detailOf(error)?.faults ?? [];
  return [
    ConnectError.from(error).rawMessage,
    ...faults.map((fault) => `${fault.subject}: ${fault.message}`),
  ].join('\n');
}

/** The token is missing, unknown or has ended. */
export function isUnauthenticated(error: unknown): boolean {
  return error instanceof ConnectError && error.code === Code.Unauthenticated;
}

/** No answer came from the server: it is gone, restarting, or the network is. */
export function isConnectionLost(error: unknown): boolean {
  if (!(error instanceof ConnectError)) return false;
  // fetch() says TypeError for every failure below HTTP, and so does reading a body that breaks off.
  if (error.cause instanceof TypeError) return true;
  // What the server itself says, for example of a camera that is gone, carries a reason.
  const unanswered = error.code === Code.Unavailable || error.code === Code.DeadlineExceeded;
  return unanswered && reasonOf(error) === '';
}

/** Key of the heading, under `error` of the shell's texts, that fits an error. */
export function headingOf(error: unknown) {
  if (isConnectionLost(error)) return 'error.connection';
  switch (ConnectError.from(error).code) {
    case Code.InvalidArgument:
    case Code.OutOfRange:
      return 'error.invalid';
    case Code.NotFound:
      return 'error.notFound';
    case Code.AlreadyExists:
      return 'error.exists';
    case Code.PermissionDenied:
      return 'error.denied';
    case Code.Unauthenticated:
      return 'error.login';
    case Code.FailedPrecondition:
      return 'error.notNow';
    case Code.Aborted:
      return 'error.changed';
    case Code.ResourceExhausted:
      return 'error.tooMuch';
    case Code.DeadlineExceeded:
      return 'error.late';
    default:
      return 'error.other';
  }
}
