// A server inside the test. The page's own clients and interceptors are used; only the network is
// not. In a test:  vi.mock('@connectrpc/connect-web', async () =>
//                    (await import('../test/fakeServer')).connectWeb);
import { type ConnectRouter, createRouterTransport, type Transport } from '@connectrpc/connect';
import type { GrpcWebTransportOptions } from '@connectrpc/connect-web';
import type { Role } from '../gen/visionserver/v1/session_pb';
import { useConnection } from '../api/connection';
import { queryClient } from '../api/queryClient';
import { useSession } from '../api/session';

let routes: (router: ConnectRouter) => void = () => {};

/** What the server answers from now on. */
export function serve(answers: (router: ConnectRouter) => void): void {
  routes = answers;
}

export const connectWeb = {
  createGrpcWebTransport: ({ interceptors }: GrpcWebTransportOptions): Transport => {
    const now = () => createRouterTransport(routes, { transport: { interceptors } });
    return {
      unary: (...call) => now().unary(...call),
      stream: (...call) => now().stream(...call),
    };
  },
};

/** As after a login; each user has the token "token of NAME". */
export function logIn(user: string, role: Role, token = `token of ${user}`): void {
  useSession.getState().setLogin({
    token,
    user,
    role,
    sessionId: `session of ${user}`,
    mustChangePassword: false,
  });
}

/** As in a tab that was just opened. */
export function freshTab(): void {
  useSession.getState().clear();
  useConnection.setState({ lost: false, recoveries: 0 });
  queryClient.clear();
  localStorage.clear();
}
