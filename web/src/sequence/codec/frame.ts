import type { FrameHeader, RectifiedGeometry } from '../../gen/visionserver/v1/stream_pb';

/** What every unpacked item has. */
export interface FrameBase {
  width: number;
  height: number;
  /** Pixel (x, y) stands for the pixel (x * step, y * step) of the full size. */
  step: number;
  frameNumber: bigint;
  /** Wall-clock time of the exposure. */
  captureTime: Date;
}

/** A disparity or depth map; the pixels are as the server stores them, 0 where invalid. */
export interface MapFrame extends FrameBase {
  kind: 'disparity' | 'depth';
  stored: Uint16Array;
  /** InvalidReason of each pixel. */
  reasons: Uint8Array | undefined;
  /** stored * scale + offset is the disparity in px, or the depth in m. */
  scale: number;
  offset: number;
  geometry: RectifiedGeometry;
}

export interface PictureFrame extends FrameBase {
  kind: 'picture';
  bitmap: ImageBitmap;
  /** Lossless: the grey values are those that the server has. */
  exact: boolean;
}

export type Frame = MapFrame | PictureFrame;

export function baseOf(header: FrameHeader): FrameBase {
  const time = header.captureTime;
  return {
    width: header.width,
    height: header.height,
    step: Math.max(1, header.step),
    frameNumber: header.frameNumber,
    captureTime: new Date(time ? Number(time.seconds) * 1000 + time.nanos / 1e6 : 0),
  };
}
