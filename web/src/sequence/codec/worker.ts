// Unpacks pixels beside the page's own thread, so that drawing and typing never wait for it.
import type { Packing } from './unpack';
import { unpackMap, unpackPicture, unpackPlane } from './unpack';

export interface MapRequest {
  id: number;
  kind: 'map';
  width: number;
  height: number;
  packing: Packing;
  payload: Uint8Array<ArrayBuffer>;
  reasons: Uint8Array<ArrayBuffer> | undefined;
}

export interface PictureRequest {
  id: number;
  kind: 'picture';
  width: number;
  height: number;
  packing: 'raw' | 'jpeg';
  payload: Uint8Array<ArrayBuffer>;
}

export type Request = MapRequest | PictureRequest;

export type Reply =
  | { id: number; kind: 'map'; stored: Uint16Array; reasons: Uint8Array | undefined }
  | { id: number; kind: 'picture'; bitmap: ImageBitmap }
  | { id: number; kind: 'error'; message: string };

async function unpack(request: Request): Promise<{ reply: Reply; transfer: Transferable[] }> {
  const { id, width, height, payload } = request;
  if (request.kind === 'picture') {
    const source =
      request.packing === 'jpeg'
        ? new Blob([payload], { type: 'image/jpeg' })
        : new ImageData(unpackPicture(payload, width * height), width, height);
    const bitmap = await createImageBitmap(source, { colorSpaceConversion: 'none' });
    return { reply: { id, kind: 'picture', bitmap }, transfer: [bitmap] };
  }
  const { packing } = request;
  const stored = unpackMap(payload, packing, width * height);
  const reasons =
    request.reasons && unpackPlane(request.reasons, packing, width * height);
  return {
    reply: { id, kind: 'map', stored, reasons },
    transfer: reasons ? [stored.buffer, reasons.buffer] : [stored.buffer],
  };
}

self.onmessage = ({ data }: MessageEvent<Request>) => {
  unpack(data).then(
    ({ reply, transfer }) => self.postMessage(reply, { transfer }),
    (error: unknown) => {
      const message = error instanceof Error ? error.message : String(error);
      self.postMessage({ id: data.id, kind: 'error', message } satisfies Reply);
    },
  );
};
