import { timestampFromDate } from '@bufbuild/protobuf/wkt';
import { Button, Group, Modal, NativeSelect, Stack, TextInput } from '@mantine/core';
import { type FormEvent, useState } from 'react';
import { useTranslation } from 'react-i18next';
import { pageApi } from '../api/pageClients';
import { Role } from '../gen/visionserver/v1/session_pb';
import type { CreateApiKeyResponse } from '../gen/visionserver/v1/user_pb';
import { ErrorNote } from '../shell/ErrorNote';
import { roleName } from '../shell/roles';
import { useChange } from './queries';
import { useRoleChoices } from './useRoleChoices';

function CreateApiKeyForm({
  onCreated,
  onCancel,
}: {
  onCreated: (answer: CreateApiKeyResponse) => void;
  onCancel: () => void;
}) {
  const { t } = useTranslation(['admin', 'shell']);
  const [name, setName] = useState('');
  const [role, setRole] = useState(Role.ROBOT);
  const [expires, setExpires] = useState('');
  const roles = useRoleChoices([Role.ROBOT, Role.VIEWER]);
  const create = useChange(
    () =>
      pageApi.users.createApiKey({
        name,
        role,
        expires: expires ? timestampFromDate(new Date(expires)) : undefined,
      }),
    { onSuccess: onCreated },
  );
  const submit = (event: FormEvent) => {
    event.preventDefault();
    create.mutate(undefined);
  };
  return (
    <form onSubmit={submit}>
      <Stack>
        <TextInput
          label={t('name')}
          description={t('keyNameHelp')}
          value={name}
          onChange={(event) => setName(event.currentTarget.value)}
          autoComplete="off"
          required
          data-autofocus
        />
        <NativeSelect
          label={t('role')}
          description={t(`roleHelp.${roleName(role)}`)}
          data={roles}
          value={String(role)}
          onChange={(event) => setRole(Number(event.currentTarget.value))}
        />
        <TextInput
          type="datetime-local"
          label={t('endsAt')}
          description={t('endsHelp')}
          value={expires}
          onChange={(event) => setExpires(event.currentTarget.value)}
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

/** Asks for name, role and end of a new API key. */
export function CreateApiKeyDialog({
  opened,
  onCreated,
  onCancel,
}: {
  opened: boolean;
  onCreated: (answer: CreateApiKeyResponse) => void;
  onCancel: () => void;
}) {
  const { t } = useTranslation(['admin', 'shell']);
  return (
    <Modal
      opened={opened}
      onClose={onCancel}
      title={t('newKey')}
      closeButtonProps={{ 'aria-label': t('shell:close') }}
    >
      <CreateApiKeyForm onCreated={onCreated} onCancel={onCancel} />
    </Modal>
  );
}
