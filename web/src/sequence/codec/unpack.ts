import { DecodeError, decodeRvl } from './rvl';

/** How the bytes of one plane are packed. */
export type Packing = 'raw' | 'rvl';

const littleEndian = new Uint8Array(Uint16Array.of(1).buffer)[0] === 1;

/** The pixels of a map. Throws DecodeError when the bytes are not those of such a map. */
export function unpackMap(bytes: Uint8Array, packing: Packing, pixels: number): Uint16Array {
  const unpacked = new Uint16Array(pixels);
  if (packing === 'rvl') {
    decodeRvl(bytes, unpacked);
    return unpacked;
  }
  checkSize(bytes, 2 * pixels);
  if (littleEndian) new Uint8Array(unpacked.buffer).set(bytes);
  else unpacked.forEach((_, i) => (unpacked[i] = bytes[2 * i]! | (bytes[2 * i + 1]! << 8)));
  return unpacked;
}

/** The reasons or confidences of a map. */
export function unpackPlane(bytes: Uint8Array, packing: Packing, pixels: number): Uint8Array {
  if (packing === 'raw') {
    checkSize(bytes, pixels);
    return bytes.slice();
  }
  const unpacked = new Uint8Array(pixels);
  decodeRvl(bytes, unpacked);
  return unpacked;
}

/** Grey (1 byte) or red, green, blue (3 bytes) for each pixel, as a canvas wants them. */
export function unpackPicture(
  bytes: Uint8Array,
  pixels: number,
): Uint8ClampedArray<ArrayBuffer> {
  const channels = bytes.length === pixels ? 1 : 3;
  checkSize(bytes, channels * pixels);
  const rgba = new Uint8ClampedArray(4 * pixels);
  if (channels === 1) {
    // A pixel at a time: the same three bytes and an opaque fourth, whatever the byte order.
    const words = new Uint32Array(rgba.buffer);
    const opaque = littleEndian ? 0xff000000 : 0x000000ff;
    const factor = littleEndian ? 0x010101 : 0x01010100;
    for (let i = 0; i < pixels; ++i) words[i] = opaque + bytes[i]! * factor;
    return rgba;
  }
  for (let i = 0; i < pixels; ++i) {
    rgba[4 * i] = bytes[3 * i]!;
    rgba[4 * i + 1] = bytes[3 * i + 1]!;
    rgba[4 * i + 2] = bytes[3 * i + 2]!;
    rgba[4 * i + 3] = 255;
  }
  return rgba;
}

function checkSize(bytes: Uint8Array, expected: number): void {
  if (bytes.length !== expected) {
    throw new DecodeError(`raw pixels take ${expected} bytes, these are ${bytes.length}`);
  }
}
