import { Alert, Button, Stack, Text } from '@mantine/core';
import { ConnectError } from '@connectrpc/connect';
import { useTranslation } from 'react-i18next';

/** What the server said, with a way to try again. */
export function Failure({ error, onAgain }: { error: Error; onAgain: () => void }) {
  const { t } = useTranslation('results');
  return (
    <Alert color="red" role="alert">
      <Stack gap="xs" align="start">
        <Text>{t('failed', { message: ConnectError.from(error).rawMessage })}</Text>
        <Button variant="default" size="xs" onClick={onAgain}>
          {t('again')}
        </Button>
      </Stack>
    </Alert>
  );
}
