import { Anchor, AppShell, Center, Group, Loader, Text } from '@mantine/core';
import { useQuery } from '@tanstack/react-query';
import { Suspense, useEffect } from 'react';
import { useTranslation } from 'react-i18next';
import { Link, Navigate, NavLink, Outlet, useLocation } from 'react-router';
import { api } from '../api/clients';
import { isAdmin, useSession } from '../api/session';
import { ConnectionBanner } from './ConnectionBanner';
import { Logo } from './icons';
import { PageBoundary } from './PageErrors';
import { Preferences } from './Preferences';
import { SessionDialog } from './SessionDialog';
import { UserMenu } from './UserMenu';
import { useServerInfo } from './usePageTitle';

/** Keeps role and name as the server sees them: an administrator may change them meanwhile. */
function useFreshRole() {
  const { login, setLogin } = useSession();
  const { data } = useQuery({
    queryKey: ['whoAmI'],
    queryFn: ({ signal }) => api.sessions.whoAmI({}, { signal }),
    refetchInterval: 30_000,
    enabled: login !== null,
  });
  useEffect(() => {
    const { login, expired } = useSession.getState();
    if (!data || !login || expired || data.sessionId !== login.sessionId) return;
    if (data.role !== login.role) setLogin({ ...login, role: data.role });
  }, [data, setLogin]);
}

/** Header, navigation and the page; only for who is logged in. */
export function Layout() {
  const { t } = useTranslation('shell');
  const login = useSession((state) => state.login);
  const location = useLocation();
  const server = useServerInfo();
  useFreshRole();
  if (!login) {
    const next = encodeURIComponent(location.pathname + location.search);
    return <Navigate to={`/login?next=${next}`} replace />;
  }
  const pages = [
    { to: '/', label: t('nav.overview') },
    { to: '/results', label: t('nav.results') },
    ...(isAdmin(login.role)
      ? [
          { to: '/users', label: t('nav.users') },
          { to: '/audit', label: t('nav.audit') },
        ]
      : []),
  ];
  return (
    <AppShell header={{ height: 48 }} padding="md">
      <a className="vs-skip" href="#page">
        {t('skip')}
      </a>
      <AppShell.Header>
        <Group h="100%" px="md" wrap="nowrap" justify="space-between">
          <Group h="100%" gap="lg" wrap="nowrap">
            <Anchor component={Link} to="/" c="inherit" underline="never" title={t('home')}>
              <Group gap="xs" wrap="nowrap">
                <Logo />
                <Text fw={600} truncate maw={220}>
                  {server?.name ?? 'VisionServer'}
                </Text>
              </Group>
            </Anchor>
            <Group component="nav" h="100%" gap={0} wrap="nowrap" aria-label={t('nav.label')}>
              {pages.map(({ to, label }) => (
                <NavLink key={to} to={to} end={to === '/'} className="vs-nav-link">
                  {label}
                </NavLink>
              ))}
            </Group>
          </Group>
          <Group gap="xs" wrap="nowrap">
            <Preferences />
            <UserMenu />
          </Group>
        </Group>
      </AppShell.Header>
      <AppShell.Main id="page" tabIndex={-1}>
        <Suspense
          fallback={
            <Center mih={200}>
              <Loader aria-label={t('loading')} />
            </Center>
          }
        >
          <PageBoundary key={location.pathname}>
            <Outlet />
          </PageBoundary>
        </Suspense>
      </AppShell.Main>
      <SessionDialog />
      <ConnectionBanner />
    </AppShell>
  );
}
