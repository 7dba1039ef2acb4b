// What a page watches, read from what it asks of the server.
import { readRequest } from './api.mjs';

/**
 * To be called before the page is opened; the answer gives what it watches now, sorted: "STREAM", or
 * "STREAM WIDTH" where it wants pictures of at most so many pixels.
 */
export function followSubscriptions(page) {
  const watched = new Map();
  const set = (subscriptions) => {
    for (const { id, stream, maxWidthPx } of subscriptions) {
      watched.set(id, maxWidthPx === 0 ? stream : `${stream} ${maxWidthPx}`);
    }
  };
  page.on('request', (request) => {
    const method = request.url().match(/visionserver\.v1\.StreamService\/(\w+)$/)?.[1];
    if (method === 'Subscribe') {
      watched.clear();
      set(readRequest('SubscribeRequest', request.postDataBuffer()).subscriptions);
    } else if (method === 'UpdateSubscriptions') {
      const update = readRequest('UpdateSubscriptionsRequest', request.postDataBuffer());
      set(update.set);
      for (const id of update.remove) watched.delete(id);
    }
  });
  return () => [...watched.values()].sort();
}
