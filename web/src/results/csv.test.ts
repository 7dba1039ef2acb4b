import { Code, ConnectError, createClient, createRouterTransport } from '@connectrpc/connect';
import { expect, it } from 'vitest';

import { ResultService } from '../gen/visionserver/v1/result_pb';
import { csvName, gatherCsv } from './csv';

const bytes = (text: string) => new TextEncoder().encode(text);

it('puts the pieces of an export together and tells how far it is', async () => {
  const client = createClient(
    ResultService,
    createRouterTransport(({ rpc }) => {
      rpc(ResultService.method.exportResults, async function* () {
        yield { data: bytes('number,part\r\n') };
        await Promise.resolve();
        yield { data: bytes('1,ü\r\n') };
      });
    }),
  );
  const progress: number[] = [];
  const file = await gatherCsv(client.exportResults({}), (soFar) => progress.push(soFar));
  expect(file.size).toBe(19);
  expect(file.type).toBe('text/csv;charset=utf-8');
  expect(progress).toEqual([13, 19]);
});

it('gives no half file when the export fails on the way', async () => {
  const client = createClient(
    ResultService,
    createRouterTransport(({ rpc }) => {
      rpc(ResultService.method.exportResults, async function* () {
        yield { data: bytes('number\r\n') };
        await Promise.resolve();
        throw new ConnectError('the disk is gone', Code.DataLoss);
      });
    }),
  );
  await expect(gatherCsv(client.exportResults({}), () => {})).rejects.toThrow('the disk is gone');
});

it('names the file by local time', () => {
  expect(csvName(new Date(2026, 10, 2, 8, 5))).toBe('results 2026-11-02 08.05.csv');
});
