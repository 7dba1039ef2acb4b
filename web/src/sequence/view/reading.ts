import type { MapFrame } from '../codec/frame';
import { depth_m, disparity_px, type Point, pointOf, storedAt } from './geometry';
import { type ReasonName, reasonName } from './reasons';
import type { Pixel } from './scene';

/** What is known of one pixel. */
export interface Reading extends Pixel {
  disparity_px: number | undefined;
  depth_m: number | undefined;
  point: Point | undefined;
  /** Why it has no depth; undefined where it has, or where nobody knows. */
  reason: ReasonName | undefined;
}

/** Reads the newest map at a pixel; undefined outside of it. */
export function readingAt(map: MapFrame, { x, y }: Pixel): Reading | undefined {
  if (x < 0 || y < 0 || x >= map.width || y >= map.height) return undefined;
  const stored = storedAt(map, x, y);
  if (stored === 0) {
    const reason = map.reasons && reasonName(map.reasons[y * map.width + x]!);
    return { x, y, disparity_px: undefined, depth_m: undefined, point: undefined, reason };
  }
  return {
    x,
    y,
    disparity_px: disparity_px(map, stored),
    depth_m: depth_m(map, stored),
    point: pointOf(map, x, y),
    reason: undefined,
  };
}
