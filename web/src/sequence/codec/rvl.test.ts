// @vitest-environment node
import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { decodeRvl } from './rvl';

interface Vector {
  name: string;
  width: number;
  height: number;
  rvl: string;
  pixels?: number[];
  error?: string;
}

// The same vectors hold the C++ and the Python decoders to the format.
const vectors = JSON.parse(
  readFileSync(new URL('../../../../tests/proto/wire/vectors/rvl.json', import.meta.url), 'utf8'),
) as { images: Vector[]; faults: Vector[] };

const bytesOf = (hex: string) => Uint8Array.from(Buffer.from(hex, 'hex'));

describe('decodeRvl', () => {
  it.each(vectors.images)('unpacks $name', ({ width, height, rvl, pixels }) => {
    const unpacked = new Uint16Array(width * height).fill(77);
    decodeRvl(bytesOf(rvl), unpacked);
    expect([...unpacked]).toEqual(pixels);
  });

  it.each(vectors.faults)('refuses $name', ({ width, height, rvl, error }) => {
    const pixels = new Uint16Array(width * height);
    expect(() => decodeRvl(bytesOf(rvl), pixels)).toThrow(error);
  });

  it('reads from any place in a larger buffer', () => {
    const [vector] = vectors.images.filter((image) => image.name === 'one valid pixel');
    const buffer = new Uint8Array(9).fill(0xff);
    buffer.set(bytesOf(vector!.rvl), 3);
    const pixels = new Uint16Array(1);
    decodeRvl(buffer.subarray(3, 7), pixels);
    expect(pixels[0]).toBe(5);
  });

  it('refuses a value that a byte cannot hold', () => {
    const [vector] = vectors.images.filter((image) => image.name.startsWith('a plane'));
    expect(() => decodeRvl(bytesOf(vector!.rvl), new Uint8Array(16))).toThrow('value out of range');
  });
});
