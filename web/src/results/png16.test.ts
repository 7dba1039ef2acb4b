import { deflateSync } from 'node:zlib';
import { describe, expect, it } from 'vitest';

import { isGrey16, limits, readGrey16 } from './png16';

function chunk(type: string, data: Uint8Array): number[] {
  const length = new Uint8Array(4);
  new DataView(length.buffer).setUint32(0, data.length);
  return [...length, ...new TextEncoder().encode(type), ...data, 0, 0, 0, 0];
}

// `lines`: for each the number of its filter, then its filtered bytes.
function png(width: number, lines: number[][], bits = 16): Uint8Array {
  const header = new Uint8Array(13);
  const view = new DataView(header.buffer);
  view.setUint32(0, width);
  view.setUint32(4, lines.length);
  header[8] = bits;
  const packed = deflateSync(Uint8Array.from(lines.flat()));
  return Uint8Array.from([
    ...[0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a],
    ...chunk('IHDR', header),
    ...chunk('IDAT', packed.subarray(0, 5)),
    ...chunk('IDAT', packed.subarray(5)),
    ...chunk('IEND', new Uint8Array()),
  ]);
}

describe('16-bit pictures', () => {
  it('are told from others', () => {
    expect(isGrey16(png(1, [[0, 1, 2]]))).toBe(true);
    expect(isGrey16(png(1, [[0, 1]], 8))).toBe(false);
    expect(isGrey16(new Uint8Array(50))).toBe(false);
  });
  it('are read with every filter of the standard', async () => {
    // Each line is 256 + 2, 512 + 4, filtered by hand.
    const file = png(2, [
      [0, 1, 2, 2, 4],
      [1, 1, 2, 1, 2],
      [2, 0, 0, 0, 0],
      [3, 1, 1, 1, 1], // left and up: half of (0, 1) ... (2, 4)
      [4, 0, 0, 0, 0], // up is always nearest
    ]);
    const picture = await readGrey16(file);
    expect([picture.widthPx, picture.heightPx]).toEqual([2, 5]);
    expect([...picture.values]).toEqual(Array(5).fill([258, 516]).flat());
  });
  it('are refused when bytes are missing', async () => {
    await expect(readGrey16(png(2, [[0, 1, 2, 3]]))).rejects.toThrow('not those of 2 x 1 px');
  });
  it('have limits that leave out the unknown', async () => {
    expect(limits(await readGrey16(png(2, [[0, 0, 0, 1, 0]])))).toEqual({ least: 256, greatest: 256 });
    expect(limits(await readGrey16(png(1, [[0, 0, 0]])))).toEqual({ least: 0, greatest: 0 });
  });
});
