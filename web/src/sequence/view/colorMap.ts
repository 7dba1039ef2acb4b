// The same colours as the server's (engine/stereo/color_map.cc), so that a saved picture and the
// page agree.

export const colorMaps = ['turbo', 'viridis', 'grey', 'hue'] as const;
export type ColorMap = (typeof colorMaps)[number];

type Rgb = readonly [number, number, number];

const toByte = (value: number) => Math.round(255 * Math.min(Math.max(value, 0), 1));

/** The paper's: from red over yellow, green and blue to magenta, which is not red again. */
function hue(t: number): Rgb {
  const sextant = 5 * t;
  const rise = sextant - Math.floor(sextant);
  switch (Math.floor(sextant)) {
    case 0:
      return [255, toByte(rise), 0];
    case 1:
      return [toByte(1 - rise), 255, 0];
    case 2:
      return [0, 255, toByte(rise)];
    case 3:
      return [0, toByte(1 - rise), 255];
    case 4:
      return [toByte(rise), 0, 255];
    default:
      return [255, 0, 255];
  }
}

// Every 15th of a published table's 256 colours; straight lines between them stay within 6 levels.
// A. Mikhailov, "Turbo, An Improved Rainbow Colormap for Visualization", Google, 2019 (Apache 2.0).
const turboSamples: Rgb[] = [
  [48, 18, 59],
  [63, 62, 156],
  [70, 102, 221],
  [69, 140, 253],
  [47, 178, 244],
  [26, 212, 208],
  [34, 235, 170],
  [82, 250, 122],
  [139, 255, 75],
  [183, 247, 53],
  [219, 226, 54],
  [245, 197, 58],
  [254, 161, 48],
  [249, 117, 29],
  [232, 75, 12],
  [206, 45, 4],
  [169, 22, 1],
  [122, 4, 3],
];

// S. van der Walt and N. Smith, matplotlib's "viridis", 2015 (CC0).
const viridisSamples: Rgb[] = [
  [68, 1, 84],
  [72, 23, 105],
  [71, 42, 122],
  [67, 61, 132],
  [61, 78, 138],
  [53, 94, 141],
  [46, 109, 142],
  [41, 123, 142],
  [35, 137, 142],
  [31, 151, 139],
  [33, 165, 133],
  [46, 179, 124],
  [70, 192, 111],
  [101, 203, 94],
  [137, 213, 72],
  [176, 221, 47],
  [216, 226, 25],
  [253, 231, 37],
];

function between(samples: Rgb[], t: number): Rgb {
  const place = t * (samples.length - 1);
  const first = Math.min(Math.floor(place), samples.length - 2);
  const part = place - first;
  const mix = (channel: 0 | 1 | 2) => {
    const a = samples[first]![channel];
    return toByte((a + part * (samples[first + 1]![channel] - a)) / 255);
  };
  return [mix(0), mix(1), mix(2)];
}

const colorOf: Record<ColorMap, (t: number) => Rgb> = {
  turbo: (t) => between(turboSamples, t),
  viridis: (t) => between(viridisSamples, t),
  grey: (t) => [toByte(t), toByte(t), toByte(t)],
  hue,
};

/** A colour as a canvas holds it in one 32-bit number, opaque. */
export const packed = ([red, green, blue]: Rgb) =>
  ((255 << 24) | (blue << 16) | (green << 8) | red) >>> 0;

/** What the 256 steps from farthest (0) to nearest (255) look like, packed. */
export function palette(map: ColorMap): Uint32Array {
  return Uint32Array.from({ length: 256 }, (_, k) => packed(colorOf[map](k / 255)));
}

/** What invalid pixels look like, packed. */
export const invalidColor = (map: ColorMap) => packed(map === 'hue' ? [255, 0, 0] : [0, 0, 0]);

/** CSS of one palette step, 0 farthest to 1 nearest. */
export function cssColor(map: ColorMap, t: number): string {
  return `rgb(${colorOf[map](t).join(' ')})`;
}
