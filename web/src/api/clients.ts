import { createClient } from '@connectrpc/connect';
import { ParameterService } from '../gen/visionserver/v1/parameter_pb';
import { SequenceService } from '../gen/visionserver/v1/sequence_pb';
import { SessionService } from '../gen/visionserver/v1/session_pb';
import { StreamService } from '../gen/visionserver/v1/stream_pb';
import { SystemService } from '../gen/visionserver/v1/system_pb';
import { setProbe } from './connection';
import { bareTransport, transport } from './transport';

/** Typed clients of the services that every page needs; `pageClients.ts` has the others. */
export const api = {
  parameters: createClient(ParameterService, transport),
  sequences: createClient(SequenceService, transport),
  sessions: createClient(SessionService, transport),
  streams: createClient(StreamService, transport),
  system: createClient(SystemService, transport),
};

const bareSystem = createClient(SystemService, bareTransport);
setProbe(() => bareSystem.getServerInfo({}, { timeoutMs: 5000 }));
