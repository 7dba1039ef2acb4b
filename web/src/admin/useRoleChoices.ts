import { useTranslation } from 'react-i18next';
import { Role } from '../gen/visionserver/v1/session_pb';
import { roleKey } from '../shell/roles';

const personRoles = [Role.VIEWER, Role.OPERATOR, Role.ENGINEER, Role.ADMIN];

/** The roles that a person may have, for a select; robots have API keys. */
export function useRoleChoices(roles: Role[] = personRoles) {
  const { t } = useTranslation('shell');
  return roles.map((role) => ({ value: String(role), label: t(roleKey(role)) }));
}
