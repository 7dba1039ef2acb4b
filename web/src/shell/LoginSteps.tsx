import { Text } from '@mantine/core';
import { useState } from 'react';
import { useTranslation } from 'react-i18next';
import { useSession } from '../api/session';
import { ChangePasswordForm } from './ChangePasswordForm';
import { LoginForm } from './LoginForm';

/** Logging in, and then changing the password where it was a one-time one. */
export function LoginSteps({ user }: { user?: string }) {
  const { t } = useTranslation('shell');
  const { login, expired, setLogin } = useSession();
  const [password, setPassword] = useState<string>();
  if (login?.mustChangePassword && !expired) {
    return (
      <>
        <Text mb="sm">{t('password.mustChange')}</Text>
        <ChangePasswordForm
          user={login.user}
          oldPassword={password}
          onDone={() => setLogin({ ...login, mustChangePassword: false })}
        />
      </>
    );
  }
  return <LoginForm user={user} onLogin={setPassword} />;
}
