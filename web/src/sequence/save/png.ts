// PNG files that browsers do not write themselves: 16-bit grey, and 8-bit without an alpha channel.
// W3C, "Portable Network Graphics (PNG) Specification".

export interface PngImage {
  width: number;
  height: number;
  bits: 8 | 16;
  channels: 1 | 3;
  /** Row by row; 16-bit values with the high byte first. */
  bytes: Uint8Array;
  /** What the values mean, for whoever opens the file. */
  description: string;
}

const kSignature = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];

const crcTable = Uint32Array.from({ length: 256 }, (_, byte) => {
  let crc = byte;
  for (let bit = 0; bit < 8; ++bit) crc = crc & 1 ? 0xedb88320 ^ (crc >>> 1) : crc >>> 1;
  return crc;
});

function crcOf(bytes: Uint8Array): number {
  let crc = 0xffffffff;
  for (const byte of bytes) crc = crcTable[(crc ^ byte) & 0xff]! ^ (crc >>> 8);
  return ~crc >>> 0;
}

function chunk(type: string, data: Uint8Array): Uint8Array {
  const bytes = new Uint8Array(data.length + 12);
  const view = new DataView(bytes.buffer);
  view.setUint32(0, data.length);
  bytes.set(new TextEncoder().encode(type), 4);
  bytes.set(data, 8);
  view.setUint32(data.length + 8, crcOf(bytes.subarray(4, data.length + 8)));
  return bytes;
}

async function deflate(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const packed = new Blob([bytes]).stream().pipeThrough(new CompressionStream('deflate'));
  return new Uint8Array(await new Response(packed).arrayBuffer());
}

/** The file. */
export async function encodePng(image: PngImage): Promise<Blob> {
  const { width, height, bits, channels, bytes, description } = image;
  const header = new Uint8Array(13);
  const view = new DataView(header.buffer);
  view.setUint32(0, width);
  view.setUint32(4, height);
  header[8] = bits;
  header[9] = channels === 1 ? 0 : 2; // grey, or red, green, blue
  // Each row behind the number of its filter: 0, none.
  const stride = (width * channels * bits) / 8;
  const rows = new Uint8Array(height * (stride + 1));
  for (let y = 0; y < height; ++y) {
    rows.set(bytes.subarray(y * stride, (y + 1) * stride), y * (stride + 1) + 1);
  }
  const text = new TextEncoder().encode(`Description\0${description}`);
  const parts = [
    Uint8Array.from(kSignature),
    chunk('IHDR', header),
    chunk('tEXt', text),
    chunk('IDAT', await deflate(rows)),
    chunk('IEND', new Uint8Array()),
  ];
  return new Blob(parts as Uint8Array<ArrayBuffer>[], { type: 'image/png' });
}

/** 16-bit values as PNG stores them. */
export function highByteFirst(values: Uint16Array): Uint8Array {
  const bytes = new Uint8Array(2 * values.length);
  values.forEach((value, i) => {
    bytes[2 * i] = value >> 8;
    bytes[2 * i + 1] = value & 0xff;
  });
  return bytes;
}
