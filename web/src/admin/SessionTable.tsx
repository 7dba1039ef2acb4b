import { Button, Table, Text } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { api } from '../api/clients';
import { ErrorNote, notifyError } from '../shell/ErrorNote';
import { formatTime, kNone } from '../shell/format';
import { roleKey } from '../shell/roles';
import { HiddenTh, WideTable } from '../shell/WideTable';
import { useAllSessions, useChange } from './queries';

/** Everybody's sessions; each can be ended, but one's own ends by logging out. */
export function SessionTable() {
  const { t } = useTranslation(['admin', 'shell']);
  const sessions = useAllSessions();
  const revoke = useChange((sessionId: string) => api.sessions.revokeSession({ sessionId }), {
    onError: notifyError,
  });
  return (
    <>
      <ErrorNote error={sessions.error} />
      <WideTable label={t('sessions')}>
        <Table.Thead>
          <Table.Tr>
            <Table.Th>{t('user')}</Table.Th>
            <Table.Th>{t('role')}</Table.Th>
            <Table.Th>{t('address')}</Table.Th>
            <Table.Th>{t('client')}</Table.Th>
            <Table.Th>{t('lastUsed')}</Table.Th>
            <Table.Th>{t('endsAt')}</Table.Th>
            <HiddenTh>{t('actions')}</HiddenTh>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {sessions.data?.sessions.map((session) => (
            <Table.Tr key={session.id}>
              <Table.Td fw={600}>{session.user}</Table.Td>
              <Table.Td>{t(`shell:${roleKey(session.role)}`)}</Table.Td>
              <Table.Td>{session.address || kNone}</Table.Td>
              <Table.Td>{session.client || kNone}</Table.Td>
              <Table.Td>{formatTime(session.lastUsed)}</Table.Td>
              <Table.Td>{formatTime(session.expires)}</Table.Td>
              <Table.Td ta="right">
                {session.current ? (
                  <Text size="sm" c="dimmed">
                    {t('thisSession')}
                  </Text>
                ) : (
                  <Button
                    size="xs"
                    variant="default"
                    loading={revoke.isPending && revoke.variables === session.id}
                    onClick={() => revoke.mutate(session.id)}
                    aria-label={t('endSessionOf', { name: session.user })}
                  >
                    {t('endSession')}
                  </Button>
                )}
              </Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </WideTable>
    </>
  );
}
