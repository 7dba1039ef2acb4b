import { api } from '../../api/clients';
import { useConnection } from '../../api/connection';
import { followServerClock, serverNowNs } from '../../api/serverClock';
import { useSession } from '../../api/session';
import { Decoder } from '../codec/decoder';
import type { Surroundings } from './liveStream';
import { Multiplexer } from './multiplexer';

/** The one Subscribe of this tab. */
export const multiplexer = new Multiplexer({
  subscribe: (subscriptions, signal) => api.streams.subscribe({ subscriptions }, { signal }),
  update: (streamId, set, remove) => api.streams.updateSubscriptions({ streamId, set, remove }),
  ack: (streamId, items) => api.streams.ack({ streamId, items }),
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
// Only the delay of what is on the screen needs the clock, so it ends with the stream.
let clock: AbortController | undefined;
multiplexer.onConnection(() => {
  clock?.abort();
  clock = undefined;
  if (multiplexer.connection !== 'open') return;
  clock = new AbortController();
  void followServerClock(clock.signal);
});
