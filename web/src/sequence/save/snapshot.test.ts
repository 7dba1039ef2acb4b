// @vitest-environment node
import { create } from '@bufbuild/protobuf';
import { inflateSync } from 'node:zlib';
import { describe, expect, it } from 'vitest';
import { RectifiedGeometrySchema } from '../../gen/visionserver/v1/stream_pb';
import { isGrey16, readGrey16 } from '../../results/png16';
import type { MapFrame } from '../codec/frame';
import { encodePng } from './png';
import { depth16, disparity16, fileName, pictureImage, snapshot } from './snapshot';

// 60 px m: 60 px is 1 m.
const map: MapFrame = {
  kind: 'disparity',
  width: 3,
  height: 2,
  step: 1,
  frameNumber: 1234n,
  captureTime: new Date('2026-11-22T06:30:41.661Z'),
  stored: Uint16Array.of(960, 0, 480, 16, 961, 8),
  reasons: undefined,
  scale: 1 / 16,
  offset: 0,
  geometry: create(RectifiedGeometrySchema, { focalPx: 500, baselineM: 0.12, cxPx: 1, cyPx: 0 }),
};
const shown = { map, picture: undefined };
const bytesOf = async (blob: Blob) => new Uint8Array(await blob.arrayBuffer());

describe('a saved map', () => {
  it('is a 16-bit PNG of millimetres that a reader gives back', async () => {
    const saved = (await snapshot('depth', 'cell', shown))!;
    const bytes = await bytesOf(saved.content);
    expect(saved.name).toBe('cell_1234_20261122T063041.661Z_depth_mm.png');
    expect(isGrey16(bytes)).toBe(true);
    // 60 / 60.0625 m = 998.96 mm; 60 m and 120 m at the low end are 60000 and more than fits.
    expect(await readGrey16(bytes)).toEqual({
      widthPx: 3,
      heightPx: 2,
      values: Uint16Array.of(1000, 0, 2000, 60000, 999, 65535),
    });
    expect([...depth16(map)]).toEqual([1000, 0, 2000, 60000, 999, 65535]);
  });

  it('is a 16-bit PNG of 1/256 px, as the block SaveImages writes it', async () => {
    const saved = (await snapshot('disparity', 'cell', shown))!;
    const { values } = await readGrey16(await bytesOf(saved.content));
    expect([...values]).toEqual([60 * 256, 0, 30 * 256, 256, 15376, 128]);
    expect([...disparity16({ ...map, offset: -1 })]).toEqual([59 * 256, 0, 29 * 256, 0, 15120, 0]);
  });

  it('says in the file what its values mean', async () => {
    const { content } = (await snapshot('depth', 'cell', shown))!;
    const text = Buffer.from(await bytesOf(content)).toString('latin1');
    expect(text).toContain('tEXtDescription\0Depth in millimetres; 0 where unknown');
  });

  it('is a binary PLY of all valid points in metres', async () => {
    const saved = (await snapshot('cloud', 'cell', shown))!;
    expect(saved.name).toBe('cell_1234_20261122T063041.661Z_cloud.ply');
    const bytes = await bytesOf(saved.content);
    const text = Buffer.from(bytes).toString('latin1');
    const begin = text.indexOf('end_header\n') + 'end_header\n'.length;
    expect(text.slice(0, begin)).toBe(
      'ply\nformat binary_little_endian 1.0\n' +
        'comment metres; x right, y down, z away from the left camera\n' +
        'element vertex 5\nproperty float x\nproperty float y\nproperty float z\nend_header\n',
    );
    expect(bytes.length).toBe(begin + 5 * 12);
    const view = new DataView(bytes.buffer, begin);
    const point = (i: number) => [0, 4, 8].map((at) => view.getFloat32(12 * i + at, true));
    expect(point(0)).toEqual([Math.fround(-1 / 500), 0, 1]);
    expect(point(1)).toEqual([Math.fround(2 / 500), 0, 2]);
  });

  it('is absent where nothing is shown', async () => {
    expect(await snapshot('picture', 'cell', shown)).toBeUndefined();
    expect(await snapshot('depth', 'cell', { map: undefined, picture: undefined })).toBeUndefined();
  });
});

describe('a saved picture', () => {
  /** Width, bits, colour type, and the rows behind their filter bytes. */
  async function read(rgba: number[]) {
    const bytes = Buffer.from(
      await bytesOf(await encodePng(pictureImage(Uint8ClampedArray.from(rgba), 2, 1))),
    );
    const at = bytes.indexOf('IDAT');
    const packed = bytes.subarray(at + 4, at + 4 + bytes.readUInt32BE(at - 4));
    return {
      width: bytes.readUInt32BE(16),
      bits: bytes[24],
      colorType: bytes[25],
      rows: [...inflateSync(packed)],
      // Known of an empty chunk: the check sum of "IEND".
      end: bytes.subarray(-8).toString('hex'),
    };
  }

  it('is grey when it has no colour', async () => {
    expect(await read([7, 7, 7, 255, 200, 200, 200, 255])).toEqual({
      width: 2,
      bits: 8,
      colorType: 0,
      rows: [0, 7, 200],
      end: '49454e44ae426082',
    });
  });

  it('has red, green and blue otherwise', async () => {
    const { colorType, rows } = await read([7, 7, 7, 255, 200, 100, 0, 255]);
    expect(colorType).toBe(2);
    expect(rows).toEqual([0, 7, 7, 7, 200, 100, 0]);
  });
});

describe('names of files', () => {
  it('have sequence, frame and time in UTC', () => {
    expect(fileName('a', map, 'x.png')).toBe('a_1234_20261122T063041.661Z_x.png');
  });
});
