import { createClient } from '@connectrpc/connect';
import { AuditService } from '../gen/visionserver/v1/audit_pb';
import { CameraService } from '../gen/visionserver/v1/camera_pb';
import { ParameterService } from '../gen/visionserver/v1/parameter_pb';
import { ResultService } from '../gen/visionserver/v1/result_pb';
import { SequenceService } from '../gen/visionserver/v1/sequence_pb';
import { SessionService } from '../gen/visionserver/v1/session_pb';
import { StreamService } from '../gen/visionserver/v1/stream_pb';
import { SystemService } from '../gen/visionserver/v1/system_pb';
import { UserService } from '../gen/visionserver/v1/user_pb';
import { setProbe } from './connection';
import { bareTransport, transport } from './transport';

/** One typed client for each service of the server. */
export const api = {
  audit: createClient(AuditService, transport),
  cameras: createClient(CameraService, transport),
  parameters: createClient(ParameterService, transport),
  results: createClient(ResultService, transport),
  sequences: createClient(SequenceService, transport),
  sessions: createClient(SessionService, transport),
  streams: createClient(StreamService, transport),
  system: createClient(SystemService, transport),
  users: createClient(UserService, transport),
};

const bareSystem = createClient(SystemService, bareTransport);
setProbe(() => bareSystem.getServerInfo({}, { timeoutMs: 5000 }));
