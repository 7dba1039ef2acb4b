// @vitest-environment node
import { describe, expect, it } from 'vitest';
import { AutoRange, robustRange } from './autoRange';
import { colorMaps, invalidColor, packed, palette } from './colorMap';
import { colorize, ColorTable } from './colorize';
import { countReasons, reasonColors } from './reasons';

const rgb = (color: number) => [color & 0xff, (color >> 8) & 0xff, (color >> 16) & 0xff];

describe('colour maps', () => {
  // The ends and middles of engine/stereo/color_map.cc.
  it.each([
    ['grey', [0, 0, 0], [255, 255, 255]],
    ['hue', [255, 0, 0], [255, 0, 255]],
    ['turbo', [48, 18, 59], [122, 4, 3]],
    ['viridis', [68, 1, 84], [253, 231, 37]],
  ] as const)('%s begins and ends as the server has it', (map, far, near) => {
    expect(rgb(palette(map)[0]!)).toEqual(far);
    expect(rgb(palette(map)[255]!)).toEqual(near);
  });

  it('have the colours of their tables, and straight lines between', () => {
    expect(rgb(palette('turbo')[15]!)).toEqual([63, 62, 156]);
    expect(rgb(palette('viridis')[120]!)).toEqual([35, 137, 142]);
    // 51 steps to each sextant.
    expect(rgb(palette('hue')[51]!)).toEqual([255, 255, 0]);
    expect(rgb(palette('hue')[102]!)).toEqual([0, 255, 0]);
  });

  it('are opaque', () => {
    for (const map of colorMaps) {
      expect([...palette(map)].every((color) => color >>> 24 === 255)).toBe(true);
    }
  });
});

describe('colours of a map', () => {
  const range = { far: 100, near: 355 };

  it('run from the farthest to the nearest, and stay at the ends beyond', () => {
    const colors = new ColorTable().of('grey', range);
    const greys = [1, 100, 101, 228, 355, 356, 65535].map((stored) => rgb(colors[stored]!)[0]);
    expect(greys).toEqual([0, 0, 1, 128, 255, 255, 255]);
  });

  it('run the other way for depths, where near is small', () => {
    const colors = new ColorTable().of('grey', { far: 355, near: 100 });
    expect([100, 101, 355].map((stored) => rgb(colors[stored]!)[0])).toEqual([255, 254, 0]);
  });

  it('show invalid pixels in their own colour, or by reason', () => {
    const colors = new ColorTable().of('hue', range);
    const pixels = new Uint32Array(3);
    colorize(Uint16Array.of(0, 355, 0), undefined, colors, pixels);
    expect([...pixels].map(rgb)).toEqual([[255, 0, 0], [255, 0, 255], [255, 0, 0]]);
    colorize(Uint16Array.of(0, 355, 0), Uint8Array.of(1, 0, 200), colors, pixels);
    expect(rgb(pixels[0]!)).toEqual([0xe6, 0x9f, 0x00]);
    expect(rgb(pixels[1]!)).toEqual([255, 0, 255]);
    expect(pixels[2]).toBe(reasonColors[0]);
  });

  it('tell invalid pixels apart in each map but by a colour of its own', () => {
    expect(colorMaps.map((map) => rgb(invalidColor(map)))).toEqual([
      [0, 0, 0],
      [0, 0, 0],
      [0, 0, 0],
      [255, 0, 0],
    ]);
    expect(packed([1, 2, 3])).toBe(0xff030201);
  });
});

describe('reasons', () => {
  it('are counted, the most frequent first', () => {
    expect(countReasons(Uint8Array.of(0, 8, 8, 1, 0, 0, 0, 0))).toEqual([
      { name: 'border', share: 0.25 },
      { name: 'occluded', share: 0.125 },
    ]);
  });
});

describe('the automatic range', () => {
  const mapOf = (low: number, high: number) =>
    Uint16Array.from({ length: 15_000 }, (_, i) => low + ((high - low) * i) / 15_000);

  it('leaves out invalid pixels and one percent at either end', () => {
    const stored = mapOf(1000, 2000);
    stored.fill(0, 5000, 6000);
    stored[0] = 65535;
    const [low, high] = robustRange(stored, new Uint32Array(65536))!;
    expect(low).toBeGreaterThanOrEqual(1005);
    expect(low).toBeLessThan(1030);
    expect(high).toBeGreaterThan(1970);
    expect(high).toBeLessThan(2000);
    expect(robustRange(new Uint16Array(100), new Uint32Array(65536))).toBeUndefined();
  });

  it('stands still while the scene trembles', () => {
    const range = new AutoRange(true);
    const first = range.follow(mapOf(1000, 2000), 0);
    for (let i = 1; i < 100; ++i) {
      const tremble = i % 2 === 0 ? 15 : -15;
      expect(range.follow(mapOf(1000 + tremble, 2000 - tremble), i * 33)).toEqual(first);
    }
  });

  it('comes to a new scene within three seconds, and keeps it for an empty map', () => {
    const range = new AutoRange(true);
    range.follow(mapOf(1000, 2000), 0);
    for (let time_ms = 33; time_ms < 3000; time_ms += 33) range.follow(mapOf(3000, 3500), time_ms);
    const { far, near } = range.follow(new Uint16Array(15_000), 3000)!;
    expect(Math.abs(far - 3005)).toBeLessThan(80);
    expect(Math.abs(near - 3495)).toBeLessThan(80);
  });

  it('has the nearest as the smallest for depths', () => {
    const { far, near } = new AutoRange(false).follow(mapOf(1000, 2000), 0)!;
    expect(far).toBeGreaterThan(near);
  });
});
