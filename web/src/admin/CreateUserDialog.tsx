import { Button, Group, Modal, NativeSelect, Stack, TextInput } from '@mantine/core';
import { type FormEvent, useState } from 'react';
import { useTranslation } from 'react-i18next';
import { pageApi } from '../api/pageClients';
import { Role } from '../gen/visionserver/v1/session_pb';
import type { CreateUserResponse } from '../gen/visionserver/v1/user_pb';
import { ErrorNote } from '../shell/ErrorNote';
import { roleName } from '../shell/roles';
import { useChange } from './queries';
import { useRoleChoices } from './useRoleChoices';

function CreateUserForm({
  onCreated,
  onCancel,
}: {
  onCreated: (answer: CreateUserResponse) => void;
  onCancel: () => void;
}) {
  const { t } = useTranslation(['admin', 'shell']);
  const [name, setName] = useState('');
  const [fullName, setFullName] = useState('');
  const [role, setRole] = useState(Role.VIEWER);
  const roles = useRoleChoices();
  const create = useChange(() => pageApi.users.createUser({ name, fullName, role }), {
    onSuccess: onCreated,
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    create.mutate(undefined);
  };
  return (
    <form onSubmit={submit}>
      <Stack>
        <TextInput
          label={t('name')}
          description={t('nameHelp')}
          value={name}
          onChange={(event) => setName(event.currentTarget.value)}
          autoCapitalize="none"
          autoComplete="off"
          spellCheck={false}
          required
          data-autofocus
        />
        <TextInput
          label={t('fullName')}
          description={t('fullNameHelp')}
          value={fullName}
          onChange={(event) => setFullName(event.currentTarget.value)}
          autoComplete="off"
        />
        <NativeSelect
          label={t('role')}
          description={t(`roleHelp.${roleName(role)}`)}
          data={roles}
          value={String(role)}
          onChange={(event) => setRole(Number(event.currentTarget.value))}
        />
        <ErrorNote error={create.error} />
        <Group justify="flex-end">
          <Button variant="default" onClick={onCancel}>
            {t('shell:cancel')}
          </Button>
          <Button type="submit" loading={create.isPending}>
            {t('create')}
          </Button>
        </Group>
      </Stack>
    </form>
  );
}

/** Asks for name and role of a new user. */
export function CreateUserDialog({
  opened,
  onCreated,
  onCancel,
}: {
  opened: boolean;
  onCreated: (answer: CreateUserResponse) => void;
  onCancel: () => void;
}) {
  const { t } = useTranslation(['admin', 'shell']);
  return (
    <Modal
      opened={opened}
      onClose={onCancel}
      title={t('newUser')}
      closeButtonProps={{ 'aria-label': t('shell:close') }}
    >
      <CreateUserForm onCreated={onCreated} onCancel={onCancel} />
    </Modal>
  );
}
