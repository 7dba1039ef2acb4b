// A server's results for tests of the page: as many as wanted, numbered from 1, one each second.
import { create, type MessageInitShape } from '@bufbuild/protobuf';
import { timestampFromMs } from '@bufbuild/protobuf/wkt';
import { Code, ConnectError, createClient, createRouterTransport } from '@connectrpc/connect';

import {
  ResultClass,
  ResultSchema,
  ResultService,
  ResultState,
  type ListResultsRequest,
  type QueryResultsRequest,
  type Result,
} from '../gen/visionserver/v1/result_pb';
import { SequenceService } from '../gen/visionserver/v1/sequence_pb';
import { SystemService } from '../gen/visionserver/v1/system_pb';
import { intValue, stringValue } from './values';

export const asked = { lists: [] as ListResultsRequest[], queries: [] as QueryResultsRequest[] };
export const held = { count: 0 };

export function resultOf(number: number, change: MessageInitShape<typeof ResultSchema> = {}): Result {
  return create(ResultSchema, {
    resultId: `id-${number}`,
    number: BigInt(number),
    jobId: 'weld',
    partId: `part-${number}`,
    parameterHash: '00000000000000ab',
    creationTime: timestampFromMs(Date.UTC(2026, 10, 22, 12, 0, number)),
    resultState: ResultState.COMPLETED,
    resultClass: number % 2 === 0 ? ResultClass.FAIL : ResultClass.PASS,
    fields: [{ name: 'gap_mm', value: { kind: { case: 'doubleValue', value: number / 8 } } }],
    ...change,
  });
}

function answer(request: QueryResultsRequest) {
  asked.queries.push(request);
  if (request.sql.startsWith('DROP')) {
    throw new ConnectError('SQL: only a SELECT is allowed', Code.InvalidArgument);
  }
  const after = request.arguments[0]?.kind;
  const newer = after?.case === 'intValue' ? BigInt(held.count) - after.value : 0n;
  const cell = request.sql.includes('LIMIT 1000')
    ? intValue(newer)
    : intValue(BigInt(held.count));
  return {
    table: { columns: ['n', 'word'], rows: [{ cells: [cell, stringValue('ü')] }] },
    truncated: request.maxRows === 1,
  };
}

const transport = createRouterTransport(({ service }) => {
  service(ResultService, {
    listResults: (request) => {
      asked.lists.push(request);
      const first = request.pageToken === '' ? held.count : Number(request.pageToken) - 1;
      const last = Math.max(first - 3, 0);
      const results = [];
      for (let number = first; number > last; --number) results.push(resultOf(number));
      return { results, nextPageToken: last > 0 ? String(last + 1) : '' };
    },
    getResult: ({ resultId }) => resultOf(Number(resultId.slice(3)), { reason: 'too wide' }),
    queryResults: answer,
  });
  service(SystemService, { getServerInfo: () => ({ name: 'cell-7' }) });
  service(SequenceService, { listSequences: () => ({ sequences: [] }) });
});

export const fakeApi = {
  results: createClient(ResultService, transport),
  sequences: createClient(SequenceService, transport),
  system: createClient(SystemService, transport),
};
