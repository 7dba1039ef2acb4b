/** Packed bytes that are not the packed form of the image that they are said to be. */
export class DecodeError extends Error {}

/**
 * Unpacks the RVL bytes of exactly `pixels.length` pixels; the format is described in
 * proto/wire/rvl.h. Throws DecodeError for anything else, after which `pixels` holds no image.
 */
export function decodeRvl(packed: Uint8Array, pixels: Uint16Array | Uint8Array): void {
  if (packed.length % 4 !== 0) throw new DecodeError('truncated');
  const words = new DataView(packed.buffer, packed.byteOffset, packed.byteLength);
  const largest = pixels.BYTES_PER_ELEMENT === 1 ? 0xff : 0xffff;
  const total = pixels.length;
  let next = 0;
  let word = 0;
  let nibbles = 0;

  const longNumber = (low: number, lowBits: number): number => {
    let sum = low;
    for (let bits = lowBits; bits < 33; bits += 3) {
      const nibble = oneNibble();
      sum += (nibble & 7) * 2 ** bits;
      if ((nibble & 8) === 0) {
        if (sum > 0xffffffff) break;
        return sum;
      }
    }
    throw new DecodeError('truncated');
  };
  const oneNibble = (): number => {
    if (nibbles === 0) {
      if (next === packed.length) throw new DecodeError('truncated');
      word = words.getUint32(next, true);
      next += 4;
      nibbles = 8;
    }
    const nibble = word >>> 28;
    word <<= 4;
    --nibbles;
    return nibble;
  };
  // Nearly all numbers have one or two nibbles.
  const number = (): number => {
    const first = oneNibble();
    if (first < 8) return first;
    const second = oneNibble();
    if (second < 8) return (first & 7) | (second << 3);
    return longNumber((first & 7) | ((second & 7) << 3), 6);
  };

  let previous = 0;
  for (let index = 0; index < total; ) {
    const zeroes = number();
    const values = number();
    if (zeroes + values > total - index || zeroes + values === 0) {
      throw new DecodeError('bad run');
    }
    pixels.fill(0, index, index + zeroes);
    index += zeroes;
    for (const end = index + values; index < end; ++index) {
      const zigzag = number();
      previous += zigzag % 2 === 0 ? zigzag / 2 : -(zigzag + 1) / 2;
      if (previous <= 0 || previous > largest) throw new DecodeError('value out of range');
      pixels[index] = previous;
    }
  }
  if (next !== packed.length || (nibbles > 0 && word !== 0)) {
    throw new DecodeError('trailing bytes');
  }
}
