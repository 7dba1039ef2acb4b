// 16-bit grey PNG files, as SaveImages writes maps: browsers show only their upper 8 bits, so this
// reads all 16. W3C, "Portable Network Graphics (PNG) Specification".

export interface Grey16 {
  widthPx: number;
  heightPx: number;
  // Row by row.
  values: Uint16Array;
}

const kSignature = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];

/** Whether these bytes are a PNG file of 16-bit grey values, not interlaced. */
export function isGrey16(file: Uint8Array): boolean {
  return (
    file.length > 33 &&
    kSignature.every((byte, i) => file[i] === byte) &&
    file[24] === 16 && // bits
    file[25] === 0 && // grey
    file[28] === 0 // not interlaced
  );
}

/** All values of a file for which isGrey16 holds. Throws when the file is damaged. */
export async function readGrey16(file: Uint8Array): Promise<Grey16> {
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  const widthPx = view.getUint32(16);
  const heightPx = view.getUint32(20);
  const packed: Uint8Array<ArrayBuffer>[] = [];
  for (let at = 8; at + 12 <= file.length; ) {
    const length = view.getUint32(at);
    const type = String.fromCharCode(...file.subarray(at + 4, at + 8));
    if (type === 'IDAT') packed.push(file.slice(at + 8, at + 8 + length));
    at += length + 12;
  }
  const lines = await inflate(packed);
  const stride = widthPx * 2;
  if (lines.length !== heightPx * (stride + 1)) {
    throw new Error(`the picture has ${lines.length} bytes, not those of ${widthPx} x ${heightPx} px`);
  }
  return { widthPx, heightPx, values: unfilter(lines, stride, heightPx) };
}

async function inflate(parts: Uint8Array<ArrayBuffer>[]): Promise<Uint8Array> {
  const packed = new ReadableStream<Uint8Array<ArrayBuffer>>({
    start: (controller) => {
      for (const part of parts) controller.enqueue(part);
      controller.close();
    },
  });
  const inflated = packed.pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(inflated).arrayBuffer());
}

// Each line begins with the number of its filter and is relative to its left and upper neighbours.
function unfilter(lines: Uint8Array, stride: number, height: number): Uint16Array {
  const values = new Uint16Array((stride / 2) * height);
  let above = new Uint8Array(stride);
  for (let y = 0; y < height; ++y) {
    const start = y * (stride + 1);
    const filter = lines[start];
    const line = lines.slice(start + 1, start + 1 + stride);
    for (let x = 0; x < stride; ++x) {
      const left = x < 2 ? 0 : line[x - 2]!;
      const up = above[x]!;
      const upLeft = x < 2 ? 0 : above[x - 2]!;
      line[x]! += predicted(filter, left, up, upLeft);
    }
    for (let x = 0; x < stride; x += 2) {
      values[(y * stride + x) / 2] = (line[x]! << 8) | line[x + 1]!;
    }
    above = line;
  }
  return values;
}

type Triple = [number, number, number];

function predicted(filter: number | undefined, left: number, up: number, upLeft: number): number {
  switch (filter) {
    case 0:
      return 0;
    case 1:
      return left;
    case 2:
      return up;
    case 3:
      return (left + up) >> 1;
    case 4: {
      const guess = left + up - upLeft;
      const [a, b, c] = [guess - left, guess - up, guess - upLeft].map(Math.abs) as Triple;
      if (a <= b && a <= c) return left;
      return b <= c ? up : upLeft;
    }
    default:
      throw new Error(`the picture has a line of the unknown filter ${filter}`);
  }
}

/** The least and the greatest value that is not 0, which means unknown; 0 when there is none. */
export function limits({ values }: Grey16): { least: number; greatest: number } {
  let least = 65536;
  let greatest = 0;
  for (const value of values) {
    if (value !== 0 && value < least) least = value;
    if (value > greatest) greatest = value;
  }
  return { least: greatest === 0 ? 0 : least, greatest };
}
