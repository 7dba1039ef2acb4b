import { Button, Modal, Stack, Text } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { queryClient } from '../api/queryClient';
import { useSession } from '../api/session';
import { LoginSteps } from './LoginSteps';

/**
 * Asks for the password over the page when the session has ended, or for a new one when an
 * administrator has reset it; the page below keeps all that was typed into it.
 */
export function SessionDialog() {
  const { t } = useTranslation('shell');
  const { login, expired, clear } = useSession();
  const leave = () => {
    clear();
    queryClient.clear();
  };
  return (
    <Modal
      opened={login !== null && (expired || login.mustChangePassword)}
      onClose={() => {}}
      withCloseButton={false}
      closeOnEscape={false}
      closeOnClickOutside={false}
      title={t('expired.title')}
      zIndex={400}
      centered
    >
      <Stack>
        {expired && <Text size="sm">{t('expired.text')}</Text>}
        <LoginSteps user={login?.user} />
        <Button variant="subtle" onClick={leave}>
          {t('expired.leave')}
        </Button>
      </Stack>
    </Modal>
  );
}
