// @vitest-environment node
import { create } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { RectifiedGeometrySchema } from '../../gen/visionserver/v1/stream_pb';
import type { MapFrame } from '../codec/frame';
import { type Matrix4, pick } from './pick';

// Depths in centimetres: a wall at 2 m with a box of 1 m in columns 60 to 79.
const map: MapFrame = {
  kind: 'depth',
  width: 100,
  height: 50,
  step: 1,
  frameNumber: 1n,
  captureTime: new Date(0),
  stored: Uint16Array.from({ length: 5000 }, (_, i) =>
    i % 100 < 10 ? 0 : i % 100 >= 60 && i % 100 < 80 ? 100 : 200,
  ),
  reasons: undefined,
  scale: 0.01,
  offset: 0,
  geometry: create(RectifiedGeometrySchema, { focalPx: 100, baselineM: 0.1, cxPx: 50, cyPx: 25 }),
};
const size = { width: 1000, height: 500 };

// The left camera's own view, ten screen pixels for one of the map: clip x = (x f / z) / 50,
// y upwards.
// prettier-ignore
const fromCamera: Matrix4 = [
  2, 0, 0, 0,
  0, -4, 0, 0,
  0, 0, 1, 1,
  0, 0, -0.1, 0,
];

describe('pick', () => {
  it('finds the pixel that is seen at a place', () => {
    expect(pick(map, fromCamera, { x: 300, y: 200 }, size)).toEqual({ x: 30, y: 20 });
    expect(pick(map, fromCamera, { x: 703, y: 98 }, size)).toEqual({ x: 70, y: 10 });
  });

  it('finds nothing where there is no point', () => {
    expect(pick(map, fromCamera, { x: 30, y: 200 }, size)).toBeUndefined();
  });

  it('prefers what is in front', () => {
    // Moved to the left by so much that the box covers the wall: 0.2 m at 1 m are 20 pixels, at 2 m
    // 10, so the box's column 60 and the wall's column 50 are both seen at 400.
    const moved = [...fromCamera];
    moved[12] = -0.4;
    const found = pick(map, moved, { x: 402, y: 250 }, size);
    expect(found?.x).toBe(60);
  });
});
