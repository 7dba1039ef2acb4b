import { Role } from '../gen/visionserver/v1/session_pb';

/** A role as it is named in keys of texts. */
export function roleName(role: Role) {
  switch (role) {
    case Role.VIEWER:
      return 'viewer';
    case Role.OPERATOR:
      return 'operator';
    case Role.ENGINEER:
      return 'engineer';
    case Role.ADMIN:
      return 'admin';
    case Role.ROBOT:
      return 'robot';
    default:
      return 'unknown';
  }
}

/** Key of a role's name in the shell's texts. */
export function roleKey(role: Role) {
  return `role.${roleName(role)}` as const;
}
