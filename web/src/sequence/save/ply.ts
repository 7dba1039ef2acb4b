import type { MapFrame } from '../codec/frame';
import { pointOf } from '../view/geometry';

/** All valid points of a map in one PLY file, as the server writes them: binary, metres. */
export function encodePly(map: MapFrame): Blob {
  const points: number[] = [];
  for (let y = 0; y < map.height; ++y) {
    for (let x = 0; x < map.width; ++x) {
      const point = pointOf(map, x, y);
      if (point) points.push(point.x_m, point.y_m, point.z_m);
    }
  }
  const header = [
    'ply',
    'format binary_little_endian 1.0',
    'comment metres; x right, y down, z away from the left camera',
    `element vertex ${points.length / 3}`,
    'property float x',
    'property float y',
    'property float z',
    'end_header',
    '',
  ].join('\n');
  const body = new DataView(new ArrayBuffer(points.length * 4));
  points.forEach((value, i) => body.setFloat32(4 * i, value, true));
  return new Blob([header, body.buffer], { type: 'application/octet-stream' });
}
