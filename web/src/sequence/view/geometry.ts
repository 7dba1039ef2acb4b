import type { MapFrame } from '../codec/frame';

/** A point in the left view's frame: x right, y down, z forward, metres. */
export interface Point {
  x_m: number;
  y_m: number;
  z_m: number;
}

type Scaled = Pick<MapFrame, 'kind' | 'scale' | 'offset' | 'geometry'>;

/** The depth in metres of a stored value above 0; infinite or negative for what is not in front. */
export function depth_m(map: Scaled, stored: number): number {
  const value = stored * map.scale + map.offset;
  if (map.kind === 'depth') return value;
  const { focalPx, baselineM, principalOffsetPx } = map.geometry;
  return (focalPx * baselineM) / (value + principalOffsetPx);
}

/** The disparity in pixels of a stored value above 0. */
export function disparity_px(map: Scaled, stored: number): number {
  const value = stored * map.scale + map.offset;
  if (map.kind === 'disparity') return value;
  const { focalPx, baselineM, principalOffsetPx } = map.geometry;
  return (focalPx * baselineM) / value - principalOffsetPx;
}

/** The value, not rounded, that is stored for a depth. */
export function storedOf(map: Scaled, depth: number): number {
  if (map.kind === 'depth') return (depth - map.offset) / map.scale;
  const { focalPx, baselineM, principalOffsetPx } = map.geometry;
  return ((focalPx * baselineM) / depth - principalOffsetPx - map.offset) / map.scale;
}

/** The point that pixel (x, y) of the full size sees at this depth. */
export function pointAt(map: Scaled, x: number, y: number, z_m: number): Point {
  const { focalPx, cxPx, cyPx } = map.geometry;
  return { x_m: ((x - cxPx) * z_m) / focalPx, y_m: ((y - cyPx) * z_m) / focalPx, z_m };
}

/** The point at pixel (x, y) of the map; undefined where it is invalid or outside. */
export function pointOf(map: MapFrame, x: number, y: number): Point | undefined {
  const stored = storedAt(map, x, y);
  if (stored === 0) return undefined;
  const z_m = depth_m(map, stored);
  if (!(z_m > 0 && Number.isFinite(z_m))) return undefined;
  return pointAt(map, x * map.step, y * map.step, z_m);
}

/** 0 where invalid or outside. */
export function storedAt(map: MapFrame, x: number, y: number): number {
  if (x < 0 || y < 0 || x >= map.width || y >= map.height) return 0;
  return map.stored[y * map.width + x]!;
}

/**
 * How much depth changes with half of the smallest step that is stored, metres: the part of a
 * measured depth's uncertainty that comes from rounding.
 */
export function depthStep_m(map: Scaled, stored: number): number {
  return Math.abs(depth_m(map, stored + 0.5) - depth_m(map, stored - 0.5)) / 2;
}

export interface Distance {
  distance_m: number;
  /** From the rounding of both depths, each moving its point along its own line of sight. */
  uncertainty_m: number;
}

export function distance(map: Scaled, a: Point, b: Point): Distance {
  const difference = [b.x_m - a.x_m, b.y_m - a.y_m, b.z_m - a.z_m];
  const distance_m = Math.hypot(...difference);
  const part = (p: Point) => {
    const along = distance_m > 0 ? Math.abs(dot(direction(p), difference)) / distance_m : 1;
    return along * depthStep_m(map, storedOf(map, p.z_m)) * (norm(p) / p.z_m);
  };
  return { distance_m, uncertainty_m: Math.hypot(part(a), part(b)) };
}

const norm = (p: Point) => Math.hypot(p.x_m, p.y_m, p.z_m);
const direction = (p: Point) => [p.x_m, p.y_m, p.z_m].map((value) => value / norm(p));
const dot = (a: number[], b: number[]) => a.reduce((sum, value, i) => sum + value * b[i]!, 0);
