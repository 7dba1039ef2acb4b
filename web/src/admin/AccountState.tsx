import { Text } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import type { User } from '../gen/visionserver/v1/user_pb';
import { formatTime } from '../shell/format';

/** State of an account in words: locked, disabled, waiting for its first password, or fine. */
export function AccountState({ user }: { user: User }) {
  const { t } = useTranslation('admin');
  if (user.disabled) return <Text size="sm">{t('disabled')}</Text>;
  if (user.lockedUntil) {
    return (
      <Text size="sm" c="var(--vs-bad)">
        {t('lockedUntil', { time: formatTime(user.lockedUntil) })}
      </Text>
    );
  }
  return <Text size="sm">{user.mustChangePassword ? t('oneTimePassword') : t('active')}</Text>;
}
