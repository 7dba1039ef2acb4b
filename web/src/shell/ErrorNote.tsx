import { Alert } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { headingOf, messageOf } from '../api/errors';
import { i18next } from '../i18n';
import { AlertIcon } from './icons';
import { showMessage } from './messages';

/** An error where it happened: a heading in the user's language, and the server's own text. */
export function ErrorNote({ error }: { error: unknown }) {
  const { t } = useTranslation('shell');
  if (!error) return null;
  return (
    <Alert
      role="alert"
      color="red"
      variant="outline"
      icon={<AlertIcon />}
      title={t(headingOf(error))}
    >
      <span style={{ whiteSpace: 'pre-line' }}>{messageOf(error)}</span>
    </Alert>
  );
}

/** An error of something that has no place of its own on the page, such as a button in a table. */
export function notifyError(error: unknown): void {
  showMessage({
    kind: 'error',
    title: i18next.t(headingOf(error), { ns: 'shell' }),
    text: messageOf(error),
  });
}
