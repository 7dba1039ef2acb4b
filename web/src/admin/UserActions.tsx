import { ActionIcon, Menu } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import type { User } from '../gen/visionserver/v1/user_pb';
import { MoreIcon } from '../shell/icons';

export type UserAction = 'enable' | 'disable' | 'unlock' | 'resetPassword' | 'delete';

/** The menu at the end of a user's row. */
export function UserActions({
  user,
  onAction,
}: {
  user: User;
  onAction: (action: UserAction, user: User) => void;
}) {
  const { t } = useTranslation('admin');
  const actions: UserAction[] = [
    ...(user.lockedUntil ? (['unlock'] as const) : []),
    user.disabled ? 'enable' : 'disable',
    'resetPassword',
    'delete',
  ];
  return (
    <Menu position="bottom-end">
      <Menu.Target>
        <ActionIcon variant="default" aria-label={t('actionsOf', { name: user.name })}>
          <MoreIcon />
        </ActionIcon>
      </Menu.Target>
      <Menu.Dropdown>
        {actions.map((action) => (
          <Menu.Item
            key={action}
            c={action === 'delete' ? 'var(--vs-bad)' : undefined}
            onClick={() => onAction(action, user)}
          >
            {t(action)}
          </Menu.Item>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
}
