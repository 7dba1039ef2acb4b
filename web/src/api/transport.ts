import type { Interceptor } from '@connectrpc/connect';
import { createGrpcWebTransport } from '@connectrpc/connect-web';
import { useSession } from './session';

const withToken: Interceptor = (next) => (request) => {
  const login = useSession.getState().login;
  if (login) request.header.set('authorization', `Bearer ${login.token}`);
  return next(request);
};

/** All calls go to the page's own origin, as gRPC-Web in its binary form. */
export const transport = createGrpcWebTransport({
  baseUrl: window.location.origin,
  interceptors: [withToken],
});
