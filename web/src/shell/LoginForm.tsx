import { Button, PasswordInput, Stack, TextInput } from '@mantine/core';
import { useMutation } from '@tanstack/react-query';
import { type FormEvent, useState } from 'react';
import { useTranslation } from 'react-i18next';
import { api } from '../api/clients';
import { useSession } from '../api/session';
import { ErrorNote } from './ErrorNote';

/** Exchanges name and password for a session. With `user`, only that one may log in. */
export function LoginForm({
  user: fixedUser,
  onLogin,
}: {
  user?: string;
  /** Hears the password, which a change of a one-time password wants again. */
  onLogin: (password: string) => void;
}) {
  const { t } = useTranslation('shell');
  const [user, setUser] = useState(fixedUser ?? '');
  const [password, setPassword] = useState('');
  const setLogin = useSession((state) => state.setLogin);
  const login = useMutation({
    mutationFn: () => api.sessions.login({ user, password, client: t('login.client') }),
    onSuccess: (answer) => {
      onLogin(password);
      setLogin({
        token: answer.token,
        user: user.toLowerCase(),
        role: answer.role,
        sessionId: answer.sessionId,
        mustChangePassword: answer.mustChangePassword,
      });
    },
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    login.mutate();
  };
  return (
    <form onSubmit={submit}>
      <Stack>
        <TextInput
          label={t('login.user')}
          autoComplete="username"
          autoCapitalize="none"
          spellCheck={false}
          value={user}
          readOnly={fixedUser !== undefined}
          onChange={(event) => setUser(event.currentTarget.value)}
          required
          data-autofocus={fixedUser === undefined || undefined}
        />
        <PasswordInput
          label={t('login.password')}
          autoComplete="current-password"
          value={password}
          onChange={(event) => setPassword(event.currentTarget.value)}
          required
          data-autofocus={fixedUser !== undefined || undefined}
          visibilityToggleButtonProps={{ 'aria-label': t('login.showPassword') }}
        />
        <ErrorNote error={login.error} />
        <Button type="submit" loading={login.isPending} fullWidth>
          {t('login.submit')}
        </Button>
      </Stack>
    </form>
  );
}
