/** A label on a scale, `place` 0 at its beginning to 1 at its end. */
export interface Tick {
  value: number;
  place: number;
}

/** The roundest number (fewest digits) in an interval of positive numbers. */
export function roundest(from: number, to: number): number {
  const [low, high] = from < to ? [from, to] : [to, from];
  for (let exponent = Math.ceil(Math.log10(high)); exponent > -9; --exponent) {
    for (const step of [1, 0.5, 0.2, 0.1].map((part) => part * 10 ** exponent)) {
      const value = Math.ceil(low / step - 1e-9) * step;
      if (value > 0 && value <= high) return Number(value.toPrecision(12));
    }
  }
  return (low + high) / 2;
}

/**
 * Round values along a scale that need not be linear: about `count` of them, evenly spread, each
 * moved by up to a third of the distance to the next. `valueAt` takes places 0..1 and is monotonic
 * and positive; `placeOf` is its inverse.
 */
export function ticks(
  valueAt: (place: number) => number,
  placeOf: (value: number) => number,
  count: number,
): Tick[] {
  const distance = 1 / count;
  const found: Tick[] = [];
  for (let i = 0; i < count; ++i) {
    const middle = (i + 0.5) * distance;
    const value = roundest(valueAt(middle - distance / 3), valueAt(middle + distance / 3));
    if (!Number.isFinite(value)) continue;
    found.push({ value, place: placeOf(value) });
  }
  return found;
}
