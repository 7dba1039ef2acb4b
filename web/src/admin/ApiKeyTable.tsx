import { Button, Group, Table, Text } from '@mantine/core';
import { useState } from 'react';
import { useTranslation } from 'react-i18next';
import { pageApi } from '../api/pageClients';
import type { ApiKey } from '../gen/visionserver/v1/user_pb';
import ConfirmDialog from '../shell/ConfirmDialog';
import { ErrorNote } from '../shell/ErrorNote';
import { formatTime } from '../shell/format';
import { PlusIcon } from '../shell/icons';
import { roleKey } from '../shell/roles';
import { HiddenTh, WideTable } from '../shell/WideTable';
import { CreateApiKeyDialog } from './CreateApiKeyDialog';
import { useApiKeys, useChange } from './queries';
import { type Secret, SecretDialog } from './SecretDialog';

/** The keys with which robots and other machines call without logging in. */
export function ApiKeyTable() {
  const { t } = useTranslation(['admin', 'shell']);
  const keys = useApiKeys();
  const [creating, setCreating] = useState(false);
  const [secret, setSecret] = useState<Secret>();
  const [revoking, setRevoking] = useState<ApiKey>();
  const revoke = useChange((id: string) => pageApi.users.revokeApiKey({ id }), {
    onSuccess: () => setRevoking(undefined),
  });
  return (
    <>
      <Group justify="space-between" mb="sm" wrap="nowrap">
        <Text size="sm" c="dimmed">
          {t('keysText')}
        </Text>
        <Button leftSection={<PlusIcon />} onClick={() => setCreating(true)} flex="none">
          {t('newKey')}
        </Button>
      </Group>
      <ErrorNote error={keys.error} />
      <WideTable label={t('keys')}>
        <Table.Thead>
          <Table.Tr>
            <Table.Th>{t('name')}</Table.Th>
            <Table.Th>{t('role')}</Table.Th>
            <Table.Th>{t('created')}</Table.Th>
            <Table.Th>{t('createdBy')}</Table.Th>
            <Table.Th>{t('lastUsed')}</Table.Th>
            <Table.Th>{t('endsAt')}</Table.Th>
            <HiddenTh>{t('actions')}</HiddenTh>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {keys.data?.keys.map((key) => (
            <Table.Tr key={key.id}>
              <Table.Td fw={600}>{key.name}</Table.Td>
              <Table.Td>{t(`shell:${roleKey(key.role)}`)}</Table.Td>
              <Table.Td>{formatTime(key.created)}</Table.Td>
              <Table.Td>{key.createdBy}</Table.Td>
              <Table.Td>{formatTime(key.lastUsed)}</Table.Td>
              <Table.Td>{key.expires ? formatTime(key.expires) : t('never')}</Table.Td>
              <Table.Td ta="right">
                <Button
                  size="xs"
                  variant="default"
                  onClick={() => {
                    revoke.reset();
                    setRevoking(key);
                  }}
                  aria-label={t('revokeNamed', { name: key.name })}
                >
                  {t('revoke')}
                </Button>
              </Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </WideTable>
      <CreateApiKeyDialog
        opened={creating}
        onCancel={() => setCreating(false)}
        onCreated={(answer) => {
          setCreating(false);
          setSecret({
            title: t('keyOf', { name: answer.key?.name ?? '' }),
            text: t('keyText'),
            secret: answer.secret,
          });
        }}
      />
      <ConfirmDialog
        opened={revoking !== undefined}
        title={t('revokeTitle', { name: revoking?.name ?? '' })}
        text={t('revokeText')}
        action={t('revoke')}
        pending={revoke.isPending}
        error={revoke.error}
        onConfirm={() => revoking && revoke.mutate(revoking.id)}
        onCancel={() => setRevoking(undefined)}
      />
      <SecretDialog shown={secret} onClose={() => setSecret(undefined)} />
    </>
  );
}
