import type { StoredRange } from './colorize';

// One pixel in 16 is enough for percentiles.
const kStride = 15;
const kLowShare = 0.01;
const kHighShare = 0.99;
const kTimeConstantMs = 800;
// The range that is shown moves only when it is off by more than this part of itself.
const kDeadBand = 0.04;

/** Smallest and largest stored value but for 1 % at either end; undefined for an empty map. */
export function robustRange(
  stored: Uint16Array,
  histogram: Uint32Array,
): [number, number] | undefined {
  histogram.fill(0);
  let valid = 0;
  for (let i = 0; i < stored.length; i += kStride) {
    const value = stored[i]!;
    if (value === 0) continue;
    ++histogram[value]!;
    ++valid;
  }
  if (valid === 0) return undefined;
  const at = (rank: number) => {
    let value = 0;
    for (let count = 0; count <= rank; ) count += histogram[++value]!;
    return value;
  };
  return [at(Math.floor((valid - 1) * kLowShare)), at(Math.floor((valid - 1) * kHighShare))];
}

/**
 * The range of a live map for its colours: robust against outliers, and steady. It follows slowly,
 * and what is shown stays until it is clearly off, so that neither colours nor ticks flicker.
 */
export class AutoRange {
  private readonly histogram = new Uint32Array(65536);
  private smooth: [number, number] | undefined;
  private shown: [number, number] | undefined;
  private last_ms = 0;

  constructor(private readonly nearIsLarge: boolean) {}

  /** `now_ms` is of any monotonic clock. Undefined until a map had a valid pixel. */
  follow(stored: Uint16Array, now_ms: number): StoredRange | undefined {
    const measured = robustRange(stored, this.histogram);
    if (measured) {
      const part = this.smooth ? 1 - Math.exp(-(now_ms - this.last_ms) / kTimeConstantMs) : 1;
      const [low, high] = this.smooth ?? measured;
      this.smooth = [low + part * (measured[0] - low), high + part * (measured[1] - high)];
      this.show(this.smooth);
    }
    this.last_ms = now_ms;
    if (!this.shown) return undefined;
    const [low, high] = this.shown;
    return this.nearIsLarge ? { far: low, near: high } : { far: high, near: low };
  }

  private show([low, high]: [number, number]): void {
    const allowed = kDeadBand * Math.max(high - low, 1);
    const [shownLow, shownHigh] = this.shown ?? [Infinity, Infinity];
    if (Math.abs(low - shownLow) <= allowed && Math.abs(high - shownHigh) <= allowed) return;
    // Never empty, so that a flat map has colours, too.
    this.shown = [Math.round(low), Math.max(Math.round(high), Math.round(low) + 1)];
  }
}
