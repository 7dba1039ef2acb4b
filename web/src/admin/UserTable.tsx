import { Button, Group, NativeSelect, Table, Text } from '@mantine/core';
import { useState } from 'react';
import { useTranslation } from 'react-i18next';
import { pageApi } from '../api/pageClients';
import { useSession } from '../api/session';
import type { Role } from '../gen/visionserver/v1/session_pb';
import type { User } from '../gen/visionserver/v1/user_pb';
import ConfirmDialog from '../shell/ConfirmDialog';
import { ErrorNote, notifyError } from '../shell/ErrorNote';
import { formatTime, kNone } from '../shell/format';
import { PlusIcon } from '../shell/icons';
import { HiddenTh, WideTable } from '../shell/WideTable';
import { AccountState } from './AccountState';
import { CreateUserDialog } from './CreateUserDialog';
import { useChange, useUsers } from './queries';
import { type Secret, SecretDialog } from './SecretDialog';
import { UserActions, type UserAction } from './UserActions';
import { useRoleChoices } from './useRoleChoices';

/** All users, and what an administrator does with them. */
export function UserTable() {
  const { t } = useTranslation('admin');
  const me = useSession((state) => state.login?.user);
  const users = useUsers();
  const roles = useRoleChoices();
  const [creating, setCreating] = useState(false);
  const [secret, setSecret] = useState<Secret>();
  const [asked, setAsked] = useState<{ action: 'delete' | 'resetPassword'; user: User }>();

  const update = useChange(
    ({ user, ...change }: { user: User; role?: Role; disabled?: boolean }) =>
      pageApi.users.updateUser({ name: user.name, etag: user.etag, ...change }),
    { onError: notifyError },
  );
  const unlock = useChange((name: string) => pageApi.users.unlockUser({ name }), {
    onError: notifyError,
  });
  const showPassword = (name: string, password: string) =>
    setSecret({ title: t('passwordOf', { name }), text: t('passwordText'), secret: password });
  const confirmed = useChange(
    async ({ action, user }: { action: 'delete' | 'resetPassword'; user: User }) => {
      if (action === 'delete') {
        await pageApi.users.deleteUser({ name: user.name });
      } else {
        const answer = await pageApi.users.resetPassword({ name: user.name });
        showPassword(user.name, answer.oneTimePassword);
      }
    },
    { onSuccess: () => setAsked(undefined) },
  );

  const act = (action: UserAction, user: User) => {
    switch (action) {
      case 'enable':
      case 'disable':
        return update.mutate({ user, disabled: action === 'disable' });
      case 'unlock':
        return unlock.mutate(user.name);
      case 'resetPassword':
      case 'delete':
        confirmed.reset();
        return setAsked({ action, user });
    }
  };

  return (
    <>
      <Group justify="flex-end" mb="sm">
        <Button leftSection={<PlusIcon />} onClick={() => setCreating(true)}>
          {t('newUser')}
        </Button>
      </Group>
      <ErrorNote error={users.error} />
      <WideTable label={t('users')}>
        <Table.Thead>
          <Table.Tr>
            <Table.Th>{t('name')}</Table.Th>
            <Table.Th>{t('fullName')}</Table.Th>
            <Table.Th>{t('role')}</Table.Th>
            <Table.Th>{t('state')}</Table.Th>
            <Table.Th>{t('lastLogin')}</Table.Th>
            <HiddenTh>{t('actions')}</HiddenTh>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {users.data?.users.map((user) => (
            <Table.Tr key={user.name}>
              <Table.Td fw={600}>
                {user.name}
                {user.name === me && (
                  <Text span size="sm" c="dimmed">
                    {' '}
                    {t('you')}
                  </Text>
                )}
              </Table.Td>
              <Table.Td>{user.fullName || kNone}</Table.Td>
              <Table.Td>
                <NativeSelect
                  size="xs"
                  w={150}
                  data={roles}
                  value={String(user.role)}
                  aria-label={t('roleOf', { name: user.name })}
                  onChange={(event) =>
                    update.mutate({ user, role: Number(event.currentTarget.value) })
                  }
                />
              </Table.Td>
              <Table.Td>
                <AccountState user={user} />
              </Table.Td>
              <Table.Td>{formatTime(user.lastLogin)}</Table.Td>
              <Table.Td ta="right">
                <UserActions user={user} onAction={act} />
              </Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </WideTable>
      <CreateUserDialog
        opened={creating}
        onCancel={() => setCreating(false)}
        onCreated={(answer) => {
          setCreating(false);
          showPassword(answer.user?.name ?? '', answer.oneTimePassword);
        }}
      />
      <ConfirmDialog
        opened={asked !== undefined}
        title={t(`${asked?.action ?? 'delete'}Title`, { name: asked?.user.name ?? '' })}
        text={t(`${asked?.action ?? 'delete'}Text`)}
        action={t(asked?.action ?? 'delete')}
        pending={confirmed.isPending}
        error={confirmed.error}
        onConfirm={() => asked && confirmed.mutate(asked)}
        onCancel={() => setAsked(undefined)}
      />
      <SecretDialog shown={secret} onClose={() => setSecret(undefined)} />
    </>
  );
}
