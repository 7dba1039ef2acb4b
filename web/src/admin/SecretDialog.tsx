import { Button, Code, CopyButton, Group, Modal, Stack, Text } from '@mantine/core';
import { useTranslation } from 'react-i18next';

/** Something secret that the server shows only this once. */
export interface Secret {
  title: string;
  text: string;
  secret: string;
}

/** Shows a secret with a button to copy it; closed only on purpose. */
export function SecretDialog({ shown, onClose }: { shown?: Secret; onClose: () => void }) {
  const { t } = useTranslation('admin');
  return (
    <Modal
      opened={shown !== undefined}
      onClose={onClose}
      title={shown?.title}
      closeOnClickOutside={false}
      closeOnEscape={false}
      withCloseButton={false}
      centered
    >
      {shown && (
        <Stack>
          <Text>{shown.text}</Text>
          <Code block fz="lg" style={{ overflowWrap: 'anywhere', whiteSpace: 'pre-wrap' }}>
            {shown.secret}
          </Code>
          <Text size="sm" c="dimmed">
            {t('onlyOnce')}
          </Text>
          <Group justify="flex-end">
            <CopyButton value={shown.secret}>
              {({ copied, copy }) => (
                <Button variant="default" onClick={copy} data-autofocus>
                  {copied ? t('copied') : t('copy')}
                </Button>
              )}
            </CopyButton>
            <Button onClick={onClose}>{t('done')}</Button>
          </Group>
        </Stack>
      )}
    </Modal>
  );
}
