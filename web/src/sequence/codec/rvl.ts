/** Packed bytes that are not the packed form of the image that they are said to be. */
export class DecodeError extends Error {}

const kLargestNumber = 0xffffffff;

/**
 * Unpacks the RVL bytes of exactly `pixels.length` pixels; the format is described in
 * proto/wire/rvl.h. Throws DecodeError for anything else, after which `pixels` holds no image.
 *
 * One function over local variables: it runs for every pixel of every frame, and engines keep those
 * in registers, but not what functions share.
 */
export function decodeRvl(packed: Uint8Array, pixels: Uint16Array | Uint8Array): void {
  if (packed.length % 4 !== 0) throw new DecodeError('truncated');
  const words = new DataView(packed.buffer, packed.byteOffset, packed.byteLength);
  const nibbleAt = (at: number) =>
    (words.getInt32((at >>> 3) << 2, true) >>> (28 - ((at & 7) << 2))) & 15;
  const end = 2 * packed.length;
  const largest = pixels.BYTES_PER_ELEMENT === 1 ? 0xff : 0xffff;
  const total = pixels.length;
  let at = 0;
  let previous = 0;

  for (let index = 0; index < total; ) {
    const run: [number, number] = [0, 0];
    for (let part = 0; part < 2; ++part) {
      for (let nibble = 8, factor = 1; nibble > 7; factor *= 8) {
        if (at === end) throw new DecodeError('truncated');
        nibble = nibbleAt(at++);
        run[part]! += (nibble & 7) * factor;
        if (run[part]! > kLargestNumber) throw new DecodeError('truncated');
      }
    }
    const [zeroes, values] = run;
    if (zeroes + values > total - index || zeroes + values === 0) {
      throw new DecodeError('bad run');
    }
    pixels.fill(0, index, index + zeroes);
    index += zeroes;
    for (const stop = index + values; index < stop; ++index) {
      if (at === end) throw new DecodeError('truncated');
      let nibble = nibbleAt(at++);
      let zigzag = nibble & 7;
      for (let bits = 3; nibble > 7; bits += 3) {
        if (at === end) throw new DecodeError('truncated');
        if (bits > 15) throw new DecodeError('value out of range');
        nibble = nibbleAt(at++);
        zigzag |= (nibble & 7) << bits;
      }
      previous += (zigzag >>> 1) ^ -(zigzag & 1);
      if (previous <= 0 || previous > largest) throw new DecodeError('value out of range');
      pixels[index] = previous;
    }
  }

  if ((at + 7) >>> 3 !== packed.length >>> 2) throw new DecodeError('trailing bytes');
  for (; at < end; ++at) {
    if (nibbleAt(at) !== 0) throw new DecodeError('trailing bytes');
  }
}
