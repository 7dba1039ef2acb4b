import type { MapFrame } from '../codec/frame';
import { pointOf } from '../view/geometry';
import type { Pixel } from '../view/scene';

/** Column by column, as graphics libraries have it: from a point in metres to clip coordinates. */
export type Matrix4 = readonly number[];

// A point is hit within this distance of it.
const kReachPx = 8;

/**
 * The pixel of the map whose point is seen at (x, y) of a canvas of this size: of all points near
 * it the one in front. Undefined where there is none. O(pixels); only for a click.
 */
export function pick(
  map: MapFrame,
  clipFromPoint: Matrix4,
  at: { x: number; y: number },
  size: { width: number; height: number },
  step = 1,
): Pixel | undefined {
  const m = clipFromPoint;
  const row = (r: number, x: number, y: number, z: number) =>
    m[r]! * x + m[r + 4]! * y + m[r + 8]! * z + m[r + 12]!;
  let found: Pixel | undefined;
  let nearest = Infinity;
  for (let y = 0; y < map.height; y += step) {
    for (let x = 0; x < map.width; x += step) {
      const point = pointOf(map, x, y);
      if (!point) continue;
      const w = row(3, point.x_m, point.y_m, point.z_m);
      if (w <= 0) continue;
      const dx = (row(0, point.x_m, point.y_m, point.z_m) / w + 1) * (size.width / 2) - at.x;
      const dy = (1 - row(1, point.x_m, point.y_m, point.z_m) / w) * (size.height / 2) - at.y;
      const away_px = Math.hypot(dx, dy);
      if (away_px > kReachPx) continue;
      // Nearer to the eye is better; of one surface, nearer to the pointer.
      const rank = w * (1 + 0.02 * away_px);
      if (rank < nearest) {
        nearest = rank;
        found = { x, y };
      }
    }
  }
  return found;
}
