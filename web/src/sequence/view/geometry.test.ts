// @vitest-environment node
import { create } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { RectifiedGeometrySchema } from '../../gen/visionserver/v1/stream_pb';
import type { MapFrame } from '../codec/frame';
import { depth_m, depthStep_m, disparity_px, distance, pointOf, storedOf } from './geometry';
import { readingAt } from './reading';

// 500 px * 0.12 m / 60 px = 1 m.
const geometry = create(RectifiedGeometrySchema, {
  focalPx: 500,
  baselineM: 0.12,
  cxPx: 2,
  cyPx: 1,
});

const disparities: MapFrame = {
  kind: 'disparity',
  width: 4,
  height: 2,
  step: 1,
  frameNumber: 7n,
  captureTime: new Date(0),
  stored: Uint16Array.of(960, 480, 0, 0, 960, 960, 960, 1920),
  reasons: Uint8Array.of(0, 0, 1, 8, 0, 0, 0, 0),
  scale: 1 / 16,
  offset: 0,
  geometry,
};

describe('geometry of a map', () => {
  it('makes depth of disparity as the interface says', () => {
    expect(depth_m(disparities, 960)).toBeCloseTo(1, 12);
    expect(depth_m(disparities, 1920)).toBeCloseTo(0.5, 12);
    // With views whose principal points differ by 60 px, and an offset of 10 px.
    const shifted = { ...disparities, offset: 10, geometry: { ...geometry, principalOffsetPx: 50 } };
    expect(depth_m(shifted, 960)).toBeCloseTo(60 / 120, 12);
    expect(disparity_px(shifted, 960)).toBe(70);
    expect(storedOf(shifted, 0.5)).toBeCloseTo(960, 9);
  });

  it('makes disparity of depth, for depth maps', () => {
    const depths: MapFrame = { ...disparities, kind: 'depth', scale: 0.0005 };
    expect(depth_m(depths, 2000)).toBe(1);
    expect(disparity_px(depths, 2000)).toBeCloseTo(60, 12);
    expect(storedOf(depths, 1)).toBe(2000);
  });

  it('finds the point that a pixel sees', () => {
    expect(pointOf(disparities, 1, 0)).toEqual({ x_m: -2 * 0.002, y_m: -0.004, z_m: 2 });
    expect(pointOf(disparities, 2, 0)).toBeUndefined();
    expect(pointOf(disparities, 4, 0)).toBeUndefined();
  });

  it('measures distances with what rounding makes uncertain', () => {
    const a = { x_m: 0, y_m: 0, z_m: 1 };
    const b = { x_m: 0.3, y_m: 0.4, z_m: 1 };
    expect(distance(disparities, a, b).distance_m).toBeCloseTo(0.5, 12);
    // Along the line of sight: half a step of 1/16 px is 1 m / 1920 at 1 m.
    expect(depthStep_m(disparities, 960)).toBeCloseTo(1 / 1920, 6);
    const c = { x_m: 0, y_m: 0, z_m: 2 };
    const along = distance(disparities, a, c);
    expect(along.distance_m).toBe(1);
    expect(along.uncertainty_m).toBeCloseTo(Math.hypot(1 / 1920, 4 / 1920), 5);
  });
});

describe('reading of a pixel', () => {
  it('has all figures of a valid pixel', () => {
    expect(readingAt(disparities, { x: 1, y: 0 })).toEqual({
      x: 1,
      y: 0,
      disparity_px: 30,
      depth_m: 2,
      point: { x_m: -0.004, y_m: -0.004, z_m: 2 },
      reason: undefined,
    });
  });

  it('says why a pixel has none', () => {
    expect(readingAt(disparities, { x: 3, y: 0 })).toMatchObject({
      depth_m: undefined,
      reason: 'border',
    });
    expect(readingAt({ ...disparities, reasons: undefined }, { x: 3, y: 0 })?.reason).toBe(
      undefined,
    );
  });

  it('is absent outside of the map', () => {
    expect(readingAt(disparities, { x: 4, y: 0 })).toBeUndefined();
    expect(readingAt(disparities, { x: 0, y: -1 })).toBeUndefined();
  });
});
