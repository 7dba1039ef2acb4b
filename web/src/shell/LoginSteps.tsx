import { Loader, Text } from '@mantine/core';
import { lazy, Suspense, useState } from 'react';
import { useTranslation } from 'react-i18next';
import { useSession } from '../api/session';
import { LoginForm } from './LoginForm';

// Seldom wanted, so it does not come with every page.
const ChangePasswordForm = lazy(() => import('./ChangePasswordForm'));

/** Logging in, and then changing the password where it was a one-time one. */
export function LoginSteps({ user }: { user?: string }) {
  const { t } = useTranslation('shell');
  const { login, expired, setLogin } = useSession();
  const [password, setPassword] = useState<string>();
  if (login?.mustChangePassword && !expired) {
    return (
      <Suspense fallback={<Loader />}>
        <Text mb="sm">{t('password.mustChange')}</Text>
        <ChangePasswordForm
          user={login.user}
          oldPassword={password}
          onDone={() => setLogin({ ...login, mustChangePassword: false })}
        />
      </Suspense>
    );
  }
  return <LoginForm user={user} onLogin={setPassword} />;
}
