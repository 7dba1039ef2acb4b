import { Button, Loader, Menu, Modal } from '@mantine/core';
import { useMutation } from '@tanstack/react-query';
import { lazy, Suspense, useState } from 'react';
import { useTranslation } from 'react-i18next';
import { api } from '../api/clients';
import { queryClient } from '../api/queryClient';
import { useSession } from '../api/session';
import { UserIcon } from './icons';
import { showMessage } from './messages';
import { roleKey } from './roles';

// Seldom wanted, so it does not come with every page.
const ChangePasswordForm = lazy(() => import('./ChangePasswordForm'));

/** Who is logged in, and what they do with their own account. */
export function UserMenu() {
  const { t } = useTranslation('shell');
  const { login, clear } = useSession();
  const [changing, setChanging] = useState(false);
  const logout = useMutation({
    mutationFn: () => api.sessions.logout({}, { timeoutMs: 3000 }),
    // Also when the server does not answer: this tab forgets the token all the same.
    onSettled: () => {
      clear();
      queryClient.clear();
    },
  });
  if (!login) return null;
  const changed = () => {
    setChanging(false);
    showMessage({ kind: 'done', text: t('password.changed') });
  };
  return (
    <>
      <Menu position="bottom-end" width={220}>
        <Menu.Target>
          <Button variant="default" size="xs" leftSection={<UserIcon />}>
            {login.user}
          </Button>
        </Menu.Target>
        <Menu.Dropdown>
          <Menu.Label>{t(roleKey(login.role))}</Menu.Label>
          <Menu.Item onClick={() => setChanging(true)}>{t('password.title')}</Menu.Item>
          <Menu.Item onClick={() => logout.mutate()}>{t('logout')}</Menu.Item>
        </Menu.Dropdown>
      </Menu>
      <Modal
        opened={changing}
        onClose={() => setChanging(false)}
        title={t('password.title')}
        closeButtonProps={{ 'aria-label': t('close') }}
      >
        <Suspense fallback={<Loader />}>
          <ChangePasswordForm user={login.user} onDone={changed} />
        </Suspense>
      </Modal>
    </>
  );
}
