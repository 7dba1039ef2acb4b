import { Role } from '../gen/visionserver/v1/session_pb';

/** Key of a role's name in the shell's texts. */
export function roleKey(role: Role) {
  switch (role) {
    case Role.VIEWER:
      return 'role.viewer';
    case Role.OPERATOR:
      return 'role.operator';
    case Role.ENGINEER:
      return 'role.engineer';
    case Role.ADMIN:
      return 'role.admin';
    case Role.ROBOT:
      return 'role.robot';
    default:
      return 'role.unknown';
  }
}
