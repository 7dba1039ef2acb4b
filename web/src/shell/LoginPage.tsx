import { Center, FocusTrap, Group, Stack, Text, Title } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { Navigate, useSearchParams } from 'react-router';
import { useSession } from '../api/session';
import { ConnectionBanner } from './ConnectionBanner';
import { Logo } from './icons';
import { LoginSteps } from './LoginSteps';
import { Preferences } from './Preferences';
import { usePageTitle, useServerInfo } from './usePageTitle';

/** Where everybody begins; afterwards goes on to the page that was asked for. */
export function LoginPage() {
  const { t } = useTranslation('shell');
  const login = useSession((state) => state.login);
  const next = useSearchParams()[0].get('next') ?? '/';
  const server = useServerInfo();
  usePageTitle(t('login.title'));
  if (login && !login.mustChangePassword) {
    // Only a path of this page: what else stands in the address may be somebody's trap.
    return <Navigate to={/^\/(?![/\\])/.test(next) ? next : '/'} replace />;
  }
  return (
    <>
      <ConnectionBanner />
      <Center mih="100dvh" p="md">
        <Stack component="main" w={380} className="vs-panel" p="xl">
          <Group>
            <Logo />
            <div>
              <Title order={1}>VisionServer</Title>
              <Text c="dimmed" size="sm">
                {server?.name ?? window.location.host}
              </Text>
            </div>
          </Group>
          <FocusTrap active>
            <div>
              <LoginSteps />
            </div>
          </FocusTrap>
          <Group justify="center">
            <Preferences />
          </Group>
        </Stack>
      </Center>
    </>
  );
}
