import { AppShell, Group, NavLink as MantineNavLink } from '@mantine/core';
import { Suspense } from 'react';
import { useTranslation } from 'react-i18next';
import { NavLink, Outlet } from 'react-router';

/** Header, navigation and the page. */
export function Layout() {
  const { t } = useTranslation('shell');
  const pages = [
    { to: '/', label: t('overview') },
    { to: '/results', label: t('results') },
    { to: '/users', label: t('users') },
    { to: '/audit', label: t('audit') },
  ];
  return (
    <AppShell header={{ height: 48 }} padding="md">
      <AppShell.Header>
        <Group h="100%" px="md">
          {pages.map((page) => (
            <MantineNavLink key={page.to} component={NavLink} w="auto" {...page} />
          ))}
        </Group>
      </AppShell.Header>
      <AppShell.Main>
        <Suspense>
          <Outlet />
        </Suspense>
      </AppShell.Main>
    </AppShell>
  );
}
