import { api } from '../../api/clients';
import { useConnection } from '../../api/connection';
import { measureServerClock, serverNowNs } from '../../api/serverClock';
import { useSession } from '../../api/session';
import { Decoder } from '../codec/decoder';
import type { Surroundings } from './liveStream';
import { Multiplexer } from './multiplexer';

// A call that takes longer than this has lost its server.
const TIMEOUT_MS = 10_000;

/** The one Subscribe of this tab. */
export const multiplexer = new Multiplexer({
  subscribe: (subscriptions, signal) => api.streams.subscribe({ subscriptions }, { signal }),
  update: (streamId, set, remove) =>
    api.streams.updateSubscriptions({ streamId, set, remove }, { timeoutMs: TIMEOUT_MS }),
  ack: (streamId, items) => api.streams.ack({ streamId, items }, { timeoutMs: TIMEOUT_MS }),
});

/** The one decoder of this tab. */
export const decoder = new Decoder();

export const browser: Surroundings = {
  now_ms: () => performance.now(),
  serverNow_ns: serverNowNs,
  nextFrame: (draw) => requestAnimationFrame(draw),
};

// A hidden tab asks for nothing, and so does one whose user has to log in again.
function follow(): void {
  const { login, expired } = useSession.getState();
  multiplexer.setActive(document.visibilityState === 'visible' && login !== null && !expired);
}
follow();
document.addEventListener('visibilitychange', follow);
useSession.subscribe(follow);
useConnection.subscribe((now, before) => {
  if (now.recoveries !== before.recoveries) multiplexer.restart();
});
// A server that was started again may have another clock.
multiplexer.onConnection(() => {
  if (multiplexer.connection === 'open') void measureServerClock();
});
