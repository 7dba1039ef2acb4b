import { Tabs, Title } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { usePageTitle } from '../shell/usePageTitle';
import { ApiKeyTable } from './ApiKeyTable';
import { SessionTable } from './SessionTable';
import { UserTable } from './UserTable';

/** People, their sessions, and the keys of machines. */
export default function UsersPage() {
  const { t } = useTranslation('admin');
  usePageTitle(t('users'));
  return (
    <div className="vs-panel">
      <Title order={1} mb="sm">
        {t('users')}
      </Title>
      <Tabs defaultValue="users" keepMounted={false}>
        <Tabs.List mb="md">
          <Tabs.Tab value="users">{t('users')}</Tabs.Tab>
          <Tabs.Tab value="sessions">{t('sessions')}</Tabs.Tab>
          <Tabs.Tab value="keys">{t('keys')}</Tabs.Tab>
        </Tabs.List>
        <Tabs.Panel value="users">
          <UserTable />
        </Tabs.Panel>
        <Tabs.Panel value="sessions">
          <SessionTable />
        </Tabs.Panel>
        <Tabs.Panel value="keys">
          <ApiKeyTable />
        </Tabs.Panel>
      </Tabs>
    </div>
  );
}
