import type { Frame, MapFrame, PictureFrame } from '../codec/frame';
import { AutoRange } from './autoRange';
import type { StoredRange } from './colorize';
import type { Display } from './display';
import { storedOf } from './geometry';
import { Signal } from './signal';
import { Viewport } from './viewport';

/** A pixel of the full size. */
export interface Pixel {
  x: number;
  y: number;
}

/**
 * What the views of one sequence show: the newest map and picture, and where the user looks. Pixels
 * come in here from the streams, many times a second, and go to canvases; React never sees them.
 */
export class Scene {
  readonly viewport = new Viewport();
  readonly mapChanged = new Signal();
  readonly pictureChanged = new Signal();
  readonly cursorChanged = new Signal();
  /** The user has chosen a pixel, by click or key; not just moved the pointer. */
  readonly pinned = new Signal();
  readonly marksChanged = new Signal();

  map: MapFrame | undefined;
  picture: PictureFrame | undefined;
  /** Colours of the newest map run between these; undefined before the first valid pixel. */
  range: StoredRange | undefined;
  /** Red, green and blue of the picture that is on the screen. */
  colorAt: ((pixel: Pixel) => readonly [number, number, number] | undefined) | undefined;
  /** The ends of a distance, at most two. */
  marks: readonly Pixel[] = [];

  private automatic: { kind: MapFrame['kind']; range: AutoRange } | undefined;
  private hovered: Pixel | undefined;
  private chosen: Pixel | undefined;

  show(frame: Frame, display: Display, now_ms: number): void {
    if (frame.kind === 'picture') {
      const before = this.picture;
      this.picture = frame;
      if (!this.map) this.viewport.setPicture(frame);
      this.pictureChanged.emit();
      // Only now: a closed picture has no size that a view could compare.
      before?.bitmap.close();
      return;
    }
    this.map = frame;
    this.viewport.setPicture(frame);
    this.range = this.rangeOf(frame, display, now_ms);
    this.mapChanged.emit();
  }

  /** After a change of how things are shown: the same map in other colours. */
  showAgain(display: Display, now_ms: number): void {
    if (!this.map) return;
    this.range = this.rangeOf(this.map, display, now_ms);
    this.mapChanged.emit();
  }

  /** The pixel that the inspector reads: under the pointer, else the one that was chosen. */
  get cursor(): Pixel | undefined {
    return this.hovered ?? this.chosen;
  }

  hover(pixel: Pixel | undefined): void {
    this.hovered = pixel;
    this.cursorChanged.emit();
  }

  /** Chooses a pixel that is read when the pointer is away. */
  pin(pixel: Pixel | undefined): void {
    this.chosen = pixel;
    this.hovered = undefined;
    this.cursorChanged.emit();
    this.pinned.emit();
  }

  /** Adds an end of a distance; a third one begins a new distance. */
  mark(pixel: Pixel): void {
    this.marks = this.marks.length === 1 ? [this.marks[0]!, pixel] : [pixel];
    this.marksChanged.emit();
  }

  clearMarks(): void {
    this.marks = [];
    this.marksChanged.emit();
  }

  clear(): void {
    this.picture?.bitmap.close();
    this.picture = undefined;
    this.map = undefined;
  }

  private rangeOf(map: MapFrame, display: Display, now_ms: number): StoredRange | undefined {
    if (this.automatic?.kind !== map.kind) {
      this.automatic = { kind: map.kind, range: new AutoRange(map.kind === 'disparity') };
    }
    const measured = this.automatic.range.follow(map.stored, now_ms);
    const { fixedRange } = display;
    if (!fixedRange) return measured;
    return { far: storedOf(map, fixedRange.far_m), near: storedOf(map, fixedRange.near_m) };
  }
}
