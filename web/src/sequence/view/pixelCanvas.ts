import type { MapFrame } from '../codec/frame';
import { colorize } from './colorize';
import type { Pixel } from './scene';
import type { Size, Viewport } from './viewport';

// From this scale on single pixels are seen, and the crosshair frames one.
const kSeenPixelScale = 6;

export interface Marks {
  cursor: Pixel | undefined;
  ends: readonly Pixel[];
}

/**
 * A canvas that shows the part of a picture that a viewport says, with crosshair and marks. The
 * picture is kept in its own size beside it, so that zoom and pan need no new picture.
 */
export class PixelCanvas {
  private readonly context: CanvasRenderingContext2D;
  private readonly source = document.createElement('canvas');
  private readonly sourceContext: CanvasRenderingContext2D;
  private pixels: ImageData | undefined;
  private shown = false;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly viewport: Viewport,
  ) {
    this.context = canvas.getContext('2d', { alpha: false })!;
    // Read by the inspector: kept where the processor reads it quickly.
    this.sourceContext = this.source.getContext('2d', { alpha: false, willReadFrequently: true })!;
  }

  setMap(map: MapFrame, colors: Uint32Array, reasons: Uint8Array | undefined): void {
    this.fitSource(map);
    if (this.pixels?.width !== map.width || this.pixels.height !== map.height) {
      this.pixels = this.sourceContext.createImageData(map.width, map.height);
    }
    colorize(map.stored, reasons, colors, new Uint32Array(this.pixels.data.buffer));
    this.sourceContext.putImageData(this.pixels, 0, 0);
  }

  setPicture(bitmap: ImageBitmap): void {
    this.fitSource(bitmap);
    this.sourceContext.drawImage(bitmap, 0, 0);
  }

  /** Red, green and blue of a pixel of the picture itself. */
  colorAt({ x, y }: Pixel): readonly [number, number, number] | undefined {
    if (x < 0 || y < 0 || x >= this.source.width || y >= this.source.height) return undefined;
    const [red, green, blue] = this.sourceContext.getImageData(x, y, 1, 1).data;
    return [red!, green!, blue!];
  }

  /** `size` of the canvas in CSS pixels. */
  resize(size: Size): void {
    const ratio = window.devicePixelRatio;
    this.canvas.width = Math.max(1, Math.round(size.width * ratio));
    this.canvas.height = Math.max(1, Math.round(size.height * ratio));
  }

  paint(marks: Marks): void {
    const { context, viewport } = this;
    const ratio = window.devicePixelRatio;
    const { left, top, scale } = viewport.origin();
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.fillStyle = '#101113';
    context.fillRect(0, 0, this.canvas.width, this.canvas.height);
    if (this.shown) {
      // Magnified, a pixel is a square; made smaller, it is a mean.
      context.imageSmoothingEnabled = scale * ratio < 1;
      const { width, height } = viewport.pictureSize;
      context.drawImage(this.source, left, top, width * scale, height * scale);
    }
    if (marks.ends.length > 0) this.paintDistance(marks.ends);
    if (marks.cursor) this.paintCrosshair(marks.cursor, scale);
  }

  private fitSource({ width, height }: Size): void {
    this.shown = true;
    if (this.source.width === width && this.source.height === height) return;
    this.source.width = width;
    this.source.height = height;
  }

  private paintCrosshair({ x, y }: Pixel, scale: number): void {
    const { context } = this;
    const from = this.viewport.toCanvas(x, y);
    const middle = this.viewport.toCanvas(x + 0.5, y + 0.5);
    const half = scale >= kSeenPixelScale ? scale / 2 : 4;
    const reach = half + 10;
    const path = new Path2D();
    if (scale >= kSeenPixelScale) path.rect(from.x, from.y, scale, scale);
    for (const [dx, dy] of [
      [1, 0],
      [-1, 0],
      [0, 1],
      [0, -1],
    ] as const) {
      path.moveTo(middle.x + dx * half, middle.y + dy * half);
      path.lineTo(middle.x + dx * reach, middle.y + dy * reach);
    }
    this.strokeTwice(context, path);
  }

  private paintDistance(ends: readonly Pixel[]): void {
    const path = new Path2D();
    const places = ends.map(({ x, y }) => this.viewport.toCanvas(x + 0.5, y + 0.5));
    places.forEach(({ x, y }) => {
      path.moveTo(x + 5, y);
      path.arc(x, y, 5, 0, 2 * Math.PI);
    });
    if (places.length === 2) {
      path.moveTo(places[0]!.x, places[0]!.y);
      path.lineTo(places[1]!.x, places[1]!.y);
    }
    this.strokeTwice(this.context, path);
  }

  /** Light on dark, so that it is seen on any picture. */
  private strokeTwice(context: CanvasRenderingContext2D, path: Path2D): void {
    context.lineWidth = 3;
    context.strokeStyle = 'rgb(0 0 0 / 0.7)';
    context.stroke(path);
    context.lineWidth = 1;
    context.strokeStyle = '#ffffff';
    context.stroke(path);
  }
}
