import { Button, List, PasswordInput, Stack, Text } from '@mantine/core';
import { useMutation } from '@tanstack/react-query';
import { type FormEvent, useState } from 'react';
import { useTranslation } from 'react-i18next';
import { api } from '../api/clients';
import { ErrorNote } from './ErrorNote';

/** Sets the user's own password. `oldPassword`: already known, so it is not asked for again. */
export default function ChangePasswordForm({
  user,
  oldPassword,
  onDone,
}: {
  user: string;
  oldPassword?: string;
  onDone: () => void;
}) {
  const { t } = useTranslation('shell');
  const [old, setOld] = useState(oldPassword ?? '');
  const [fresh, setFresh] = useState('');
  const [again, setAgain] = useState('');
  const change = useMutation({
    mutationFn: () => api.sessions.changePassword({ oldPassword: old, newPassword: fresh }),
    onSuccess: onDone,
  });
  const differs = again !== '' && again !== fresh;
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (again === fresh) change.mutate();
  };
  const toggle = { 'aria-label': t('login.showPassword') };
  return (
    <form onSubmit={submit}>
      <Stack>
        <input type="text" autoComplete="username" value={user} readOnly hidden />
        {oldPassword === undefined && (
          <PasswordInput
            label={t('password.old')}
            autoComplete="current-password"
            value={old}
            onChange={(event) => setOld(event.currentTarget.value)}
            required
            data-autofocus
            visibilityToggleButtonProps={toggle}
          />
        )}
        <div>
          <Text size="sm">{t('password.rules')}</Text>
          <List size="sm">
            <List.Item>{t('password.ruleLength')}</List.Item>
            <List.Item>{t('password.ruleName')}</List.Item>
            <List.Item>{t('password.ruleCommon')}</List.Item>
          </List>
        </div>
        <PasswordInput
          label={t('password.new')}
          autoComplete="new-password"
          value={fresh}
          onChange={(event) => setFresh(event.currentTarget.value)}
          required
          data-autofocus={oldPassword !== undefined || undefined}
          visibilityToggleButtonProps={toggle}
        />
        <PasswordInput
          label={t('password.again')}
          autoComplete="new-password"
          value={again}
          onChange={(event) => setAgain(event.currentTarget.value)}
          required
          error={differs && t('password.differs')}
          visibilityToggleButtonProps={toggle}
        />
        <ErrorNote error={change.error} />
        <Button type="submit" loading={change.isPending} disabled={differs}>
          {t('password.submit')}
        </Button>
      </Stack>
    </form>
  );
}
