// A call made from the page itself, with the token of who is logged in there: what somebody does who
// knows the browser's developer tools.
import { requestBytes } from './api.mjs';

/** gRPC's status (0: done) and message of "Service/Method"; the answer is not looked at. */
export async function callFromPage(page, method, request) {
  const body = requestBytes(method, request);
  const trailer = await page.evaluate(
    async ([path, bytes]) => {
      const { token } = JSON.parse(sessionStorage.getItem('visionserver.session'));
      const frame = new Uint8Array(5 + bytes.length);
      new DataView(frame.buffer).setUint32(1, bytes.length);
      frame.set(bytes, 5);
      const response = await fetch(path, {
        method: 'POST',
        headers: {
          'content-type': 'application/grpc-web+proto',
          'x-grpc-web': '1',
          authorization: `Bearer ${token}`,
        },
        body: frame,
      });
      const status = response.headers.get('grpc-status');
      if (status !== null) return `grpc-status: ${status}\r\ngrpc-message: ${response.headers.get('grpc-message')}`;
      const answer = new Uint8Array(await response.arrayBuffer());
      // Frames: one byte that is 128 for the trailer, then a length, then the content.
      for (let at = 0; at < answer.length; ) {
        const length = new DataView(answer.buffer).getUint32(at + 1);
        const content = answer.subarray(at + 5, at + 5 + length);
        if (answer[at] === 128) return new TextDecoder().decode(content);
        at += 5 + length;
      }
      return '';
    },
    [`/visionserver.v1.${method}`, [...body]],
  );
  const entry = (name) => trailer.match(new RegExp(`${name}: ?(.*)`, 'i'))?.[1]?.trim() ?? '';
  return { status: Number(entry('grpc-status')), message: decodeURIComponent(entry('grpc-message')) };
}
