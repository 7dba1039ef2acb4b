import { type ColorMap, invalidColor, palette } from './colorMap';
import { reasonColors } from './reasons';

/** Stored values between which the palette runs; `far` becomes its first colour, `near` its last. */
export interface StoredRange {
  far: number;
  near: number;
}

/** Colours of all stored values, made again only when the range or the colour map changes. */
export class ColorTable {
  private readonly colors = new Uint32Array(65536);
  private made = '';

  /** The colour of each stored value, packed; of 0 that of invalid pixels. */
  of(map: ColorMap, { far, near }: StoredRange): Uint32Array {
    const wanted = `${map} ${far} ${near}`;
    if (wanted === this.made) return this.colors;
    const steps = palette(map);
    const scale = 255 / (near - far || 1);
    for (let stored = 1; stored < this.colors.length; ++stored) {
      const step = Math.round((stored - far) * scale);
      this.colors[stored] = steps[Math.min(Math.max(step, 0), 255)]!;
    }
    this.colors[0] = invalidColor(map);
    this.made = wanted;
    return this.colors;
  }
}

/** Colours a map into `pixels`; with `reasons`, invalid pixels by why they are invalid. */
export function colorize(
  stored: Uint16Array,
  reasons: Uint8Array | undefined,
  colors: Uint32Array,
  pixels: Uint32Array,
): void {
  if (!reasons) {
    for (let i = 0; i < stored.length; ++i) pixels[i] = colors[stored[i]!]!;
    return;
  }
  for (let i = 0; i < stored.length; ++i) {
    const value = stored[i]!;
    pixels[i] = value !== 0 ? colors[value]! : reasonColors[reasons[i]!]!;
  }
}
