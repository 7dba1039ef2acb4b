import { createClient } from '@connectrpc/connect';
import { AuditService } from '../gen/visionserver/v1/audit_pb';
import { CameraService } from '../gen/visionserver/v1/camera_pb';
import { ResultService } from '../gen/visionserver/v1/result_pb';
import { UserService } from '../gen/visionserver/v1/user_pb';
import { transport } from './transport';

/** Typed clients of the services that some pages need; loaded with the first of these pages. */
export const pageApi = {
  audit: createClient(AuditService, transport),
  cameras: createClient(CameraService, transport),
  results: createClient(ResultService, transport),
  users: createClient(UserService, transport),
};
