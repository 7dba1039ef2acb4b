import { Code, ConnectError } from '@connectrpc/connect';
import { describe, expect, it } from 'vitest';
import { headingOf, isConnectionLost, messageOf, reasonOf } from './errors';
import { ErrorDetailSchema } from '../gen/visionserver/v1/error_pb';

const withDetail = (
  code: Code,
  reason: string,
  faults: { subject: string; message: string }[] = [],
) => {
  const error = new ConnectError('the sequence has faults', code, undefined, [
    { desc: ErrorDetailSchema, value: { domain: 'vs', reason, faults } },
  ]);
  return error;
};

describe('an error of the server', () => {
  it('shows all faults that were found at once, in the words of the server', () => {
    const error = withDetail(Code.InvalidArgument, 'INVALID_ARGUMENT', [
      { subject: 'match.p1', message: '700 is more than 255' },
      { subject: 'left', message: 'needs a connection' },
    ]);
    expect(messageOf(error)).toBe(
      'the sequence has faults\nmatch.p1: 700 is more than 255\nleft: needs a connection',
    );
    expect(headingOf(error)).toBe('error.invalid');
  });

  it('has a reason that a program can act on', () => {
    expect(reasonOf(withDetail(Code.PermissionDenied, 'PASSWORD_CHANGE_REQUIRED'))).toBe(
      'PASSWORD_CHANGE_REQUIRED',
    );
    expect(reasonOf(new Error('else'))).toBe('');
  });
});

describe('a lost connection', () => {
  it.each([
    ConnectError.from(new TypeError('Failed to fetch')),
    new ConnectError('HTTP 503', Code.Unavailable),
    new ConnectError('the operation timed out', Code.DeadlineExceeded),
  ])('is $message', (error) => {
    expect(isConnectionLost(error)).toBe(true);
    expect(headingOf(error)).toBe('error.connection');
  });

  it('is not a camera that is gone, of which the server tells', () => {
    expect(isConnectionLost(withDetail(Code.Unavailable, 'UNAVAILABLE'))).toBe(false);
  });
});
