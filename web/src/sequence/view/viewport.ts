import { Signal } from './signal';

const kLargestScale = 64;

export interface Size {
  width: number;
  height: number;
}

/**
 * Which part of the picture is seen, and how large. One for all views that zoom and pan together:
 * the place in the middle and the scale are theirs in common, the size of a canvas is its own.
 */
export class Viewport {
  readonly changed = new Signal();
  private picture: Size = { width: 1, height: 1 };
  private canvas: Size = { width: 1, height: 1 };
  // Of the picture, in its pixels; undefined: all of it is shown, whatever the size of the canvas.
  private place: { scale: number; x: number; y: number } | undefined;

  /** Screen pixels (CSS) for one of the picture. */
  get scale(): number {
    return this.place?.scale ?? this.fitScale();
  }

  get pictureSize(): Size {
    return this.picture;
  }

  setPicture(size: Size): void {
    if (size.width === this.picture.width && size.height === this.picture.height) return;
    // Not `size` itself, which may be a frame with all its pixels.
    this.picture = { width: size.width, height: size.height };
    this.fit();
  }

  setCanvas(size: Size): void {
    if (size.width === this.canvas.width && size.height === this.canvas.height) return;
    this.canvas = size;
    this.changed.emit();
  }

  fit(): void {
    this.place = undefined;
    this.changed.emit();
  }

  /** Enlarges by `factor`; what is at (x, y) of the canvas stays there. */
  zoom(factor: number, x = this.canvas.width / 2, y = this.canvas.height / 2): void {
    const fixed = this.toPicture(x, y);
    const scale = Math.min(this.scale * factor, kLargestScale);
    if (scale <= this.fitScale()) {
      this.fit();
      return;
    }
    this.moveTo(
      scale,
      fixed.x - (x - this.canvas.width / 2) / scale,
      fixed.y - (y - this.canvas.height / 2) / scale,
    );
  }

  /** Moves the picture by so many screen pixels. */
  pan(dx: number, dy: number): void {
    if (!this.place) return;
    const { scale, x, y } = this.place;
    this.moveTo(scale, x - dx / scale, y - dy / scale);
  }

  /** Brings a place of the picture into view. */
  reveal(x: number, y: number): void {
    if (!this.place) return;
    const at = this.toCanvas(x + 0.5, y + 0.5);
    const { width, height } = this.canvas;
    if (at.x >= 0 && at.y >= 0 && at.x < width && at.y < height) return;
    this.moveTo(this.place.scale, x, y);
  }

  /** From canvas to picture; whole numbers are the upper left corners of pixels. */
  toPicture(x: number, y: number): { x: number; y: number } {
    const { left, top, scale } = this.origin();
    return { x: (x - left) / scale, y: (y - top) / scale };
  }

  toCanvas(x: number, y: number): { x: number; y: number } {
    const { left, top, scale } = this.origin();
    return { x: left + x * scale, y: top + y * scale };
  }

  /** Where the picture's upper left corner lies on the canvas. */
  origin(): { left: number; top: number; scale: number } {
    const { scale } = this;
    const x = this.place?.x ?? this.picture.width / 2;
    const y = this.place?.y ?? this.picture.height / 2;
    return { left: this.canvas.width / 2 - x * scale, top: this.canvas.height / 2 - y * scale, scale };
  }

  private fitScale(): number {
    return Math.min(
      this.canvas.width / this.picture.width,
      this.canvas.height / this.picture.height,
    );
  }

  private moveTo(scale: number, x: number, y: number): void {
    // The picture's edge comes to the canvas's edge and no further.
    const within = (value: number, size: number, visible: number) =>
      visible >= size ? size / 2 : Math.min(Math.max(value, visible / 2), size - visible / 2);
    this.place = {
      scale,
      x: within(x, this.picture.width, this.canvas.width / scale),
      y: within(y, this.picture.height, this.canvas.height / scale),
    };
    this.changed.emit();
  }
}
