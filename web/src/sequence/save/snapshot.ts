import type { FrameBase, MapFrame, PictureFrame } from '../codec/frame';
import { depth_m, disparity_px } from '../view/geometry';
import type { Scene } from '../view/scene';
import { encodePly } from './ply';
import { encodePng, highByteFirst, type PngImage } from './png';

export const snapshotKinds = ['depth', 'disparity', 'picture', 'cloud'] as const;
export type SnapshotKind = (typeof snapshotKinds)[number];

// As the block SaveImages does it, and usual in stereo data sets.
const kDisparityScale = 256;

/** Depth in millimetres, 0 where unknown. */
export function depth16(map: MapFrame): Uint16Array {
  return tabulate(map, (stored) => depth_m(map, stored) * 1000);
}

/** Disparity in 1/256 px, 0 where unknown. */
export function disparity16(map: MapFrame): Uint16Array {
  return tabulate(map, (stored) => disparity_px(map, stored) * kDisparityScale);
}

function tabulate(map: MapFrame, of: (stored: number) => number): Uint16Array {
  const table = Uint16Array.from({ length: 65536 }, (_, stored) =>
    stored === 0 ? 0 : Math.round(Math.min(Math.max(of(stored), 0), 65535)),
  );
  return map.stored.map((stored) => table[stored]!);
}

/** Grey where all three channels agree everywhere, else colour. */
export function pictureImage(rgba: Uint8ClampedArray, width: number, height: number): PngImage {
  let channels: 1 | 3 = 1;
  for (let i = 0; i < rgba.length && channels === 1; i += 4) {
    if (rgba[i] !== rgba[i + 1] || rgba[i] !== rgba[i + 2]) channels = 3;
  }
  const bytes = new Uint8Array(width * height * channels);
  for (let i = 0; i < width * height; ++i) {
    for (let c = 0; c < channels; ++c) bytes[i * channels + c] = rgba[4 * i + c]!;
  }
  return { width, height, bits: 8, channels, bytes, description: 'Left view of VisionServer' };
}

/** "stereo_depth_1234_20261122T063041.661Z_depth_mm.png": sorts by sequence, then by frame. */
export function fileName(
  sequence: string,
  { frameNumber, captureTime }: Pick<MapFrame, 'frameNumber' | 'captureTime'>,
  ending: string,
): string {
  const time = captureTime.toISOString().replace(/[-:]/g, '');
  return `${sequence}_${frameNumber}_${time}_${ending}`;
}

export interface SavedFile {
  name: string;
  content: Blob;
}

/** What was on the screen at one moment. */
export interface Shown {
  map: MapFrame | undefined;
  picture: (FrameBase & { rgba: Uint8ClampedArray }) | undefined;
}

/** Keeps the picture's pixels, which the next one takes away from the screen. */
export function shownOf({ map, picture }: Pick<Scene, 'map' | 'picture'>): Shown {
  return { map, picture: picture && { ...picture, rgba: pixelsOf(picture) } };
}

/** One file of what was on the screen; undefined where nothing of the kind was. */
export async function snapshot(
  kind: SnapshotKind,
  sequence: string,
  { map, picture }: Shown,
): Promise<SavedFile | undefined> {
  if (kind === 'picture') {
    if (!picture) return undefined;
    const { rgba, width, height } = picture;
    const content = await encodePng(pictureImage(rgba, width, height));
    return { name: fileName(sequence, picture, 'picture.png'), content };
  }
  if (!map) return undefined;
  if (kind === 'cloud') {
    return { name: fileName(sequence, map, 'cloud.ply'), content: encodePly(map) };
  }
  const depth = kind === 'depth';
  const content = await encodePng({
    width: map.width,
    height: map.height,
    bits: 16,
    channels: 1,
    bytes: highByteFirst(depth ? depth16(map) : disparity16(map)),
    description: depth
      ? 'Depth in millimetres; 0 where unknown'
      : 'Disparity in 1/256 px; 0 where unknown',
  });
  const ending = depth ? 'depth_mm.png' : 'disparity_256.png';
  return { name: fileName(sequence, map, ending), content };
}

function pixelsOf({ bitmap, width, height }: PictureFrame): Uint8ClampedArray {
  const context = new OffscreenCanvas(width, height).getContext('2d')!;
  context.drawImage(bitmap, 0, 0);
  return context.getImageData(0, 0, width, height).data;
}
