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
