// @vitest-environment node
import { describe, expect, it } from 'vitest';
import { unpackPicture } from './unpack';

describe('unpackPicture', () => {
  it('makes grey pixels of one byte each', () => {
    const bytes = Uint8Array.of(0, 128, 255);
    expect([...unpackPicture(bytes, 3)]).toEqual([0, 0, 0, 255, 128, 128, 128, 255, 255, 255, 255, 255]);
  });

  it('makes coloured pixels of three bytes each', () => {
    const bytes = Uint8Array.of(1, 2, 3, 250, 251, 252);
    expect([...unpackPicture(bytes, 2)]).toEqual([1, 2, 3, 255, 250, 251, 252, 255]);
  });

  it('refuses bytes that are not those of such a picture', () => {
    expect(() => unpackPicture(Uint8Array.of(1, 2, 3, 4), 2)).toThrow('raw pixels take 6 bytes, these are 4');
  });
});
