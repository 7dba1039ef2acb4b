/** Ends after `ms`, or at once by throwing the signal's reason when that is aborted. */
export function sleep(ms: number, signal?: AbortSignal): Promise<void> {
  return new Promise((resolve, reject) => {
    signal?.throwIfAborted();
    const aborted = () => {
      clearTimeout(timer);
      reject(signal?.reason as Error);
    };
    const timer = setTimeout(() => {
      signal?.removeEventListener('abort', aborted);
      resolve();
    }, ms);
    signal?.addEventListener('abort', aborted, { once: true });
  });
}

interface Store<State> {
  getState: () => State;
  subscribe: (listener: (state: State) => void) => () => void;
}

/** Ends once the state of a store fulfils `condition`; throws when `signal` is aborted before. */
export function until<State>(
  store: Store<State>,
  condition: (state: State) => boolean,
  signal?: AbortSignal,
): Promise<void> {
  return new Promise((resolve, reject) => {
    signal?.throwIfAborted();
    if (condition(store.getState())) return resolve();
    const aborted = () => {
      stop();
      reject(signal?.reason as Error);
    };
    const stop = store.subscribe((state) => {
      if (!condition(state)) return;
      stop();
      signal?.removeEventListener('abort', aborted);
      resolve();
    });
    signal?.addEventListener('abort', aborted, { once: true });
  });
}
