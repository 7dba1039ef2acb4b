// The CSV export: the server sends it in pieces, the browser saves it as one file.
import type { ExportResultsResponse } from '../gen/visionserver/v1/result_pb';

// Gathers the pieces; `onProgress` gets the bytes so far. Throws what the stream throws, also when
// it was aborted.
export async function gatherCsv(
  pieces: AsyncIterable<ExportResultsResponse>,
  onProgress: (bytes: number) => void,
): Promise<Blob> {
  const parts: Uint8Array<ArrayBuffer>[] = [];
  let bytes = 0;
  for await (const piece of pieces) {
    parts.push(piece.data as Uint8Array<ArrayBuffer>);
    bytes += piece.data.byteLength;
    onProgress(bytes);
  }
  return new Blob(parts, { type: 'text/csv;charset=utf-8' });
}

// "results 2026-11-22 18.31.csv": local time, in characters that every file system takes.
export function csvName(now: Date): string {
  const two = (value: number) => String(value).padStart(2, '0');
  const date = `${now.getFullYear()}-${two(now.getMonth() + 1)}-${two(now.getDate())}`;
  return `results ${date} ${two(now.getHours())}.${two(now.getMinutes())}.csv`;
}

// Hands a file to the user.
export function download(file: Blob, name: string): void {
  const address = URL.createObjectURL(file);
  const link = document.createElement('a');
  link.href = address;
  link.download = name;
  link.click();
  // The browser has begun to read by then; without this the file stays in memory.
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

// "3.4 MB".
export function bytesText(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  if (bytes < 1e6) return `${(bytes / 1e3).toFixed(1)} kB`;
  return `${(bytes / 1e6).toFixed(1)} MB`;
}
