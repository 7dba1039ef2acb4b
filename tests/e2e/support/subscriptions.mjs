// What a page watches, read from what it asks of the server.
import { readRequest } from './api.mjs';

const streamAndWidth = ({ stream, maxWidthPx }) => (maxWidthPx === 0 ? stream : `${stream} ${maxWidthPx}`);

/**
 * To be called before the page is opened; the answer gives what it watches now, sorted: "STREAM", or
 * "STREAM WIDTH" where it wants pictures of at most so many pixels; or what `text` makes of each.
 */
export function followSubscriptions(page) {
  const watched = new Map();
  const set = (subscriptions) => {
    for (const one of subscriptions) watched.set(one.id, one);
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
  return (text = streamAndWidth) => [...watched.values()].map(text).sort();
}

/**
 * To be called before the page is opened; the answer counts its Subscribe streams: how many are open
 * now, and how many were open at once at most.
 */
export async function countSubscribes(page) {
  await page.addInitScript(() => {
    const subscribes = (window.subscribes = { open: 0, mostAtOnce: 0 });
    const { fetch } = window;
    window.fetch = (address, options) => {
      const answer = fetch(address, options);
      if (!String(address).endsWith('StreamService/Subscribe')) return answer;
      subscribes.mostAtOnce = Math.max(subscribes.mostAtOnce, ++subscribes.open);
      // The page gives up each of its streams, also those that the server has ended.
      options.signal.addEventListener('abort', () => --subscribes.open, { once: true });
      return answer;
    };
  });
  return () => page.evaluate(() => window.subscribes);
}
