import { Button, Stack, Text, Title } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { Link, useRouteError } from 'react-router';

/** What stands in place of a page that failed: most likely a newer server has replaced its files. */
export function PageError() {
  const { t } = useTranslation('shell');
  const error = useRouteError();
  return (
    <Stack align="flex-start">
      <Title order={1}>{t('pageError.title')}</Title>
      <Text>{t('pageError.text')}</Text>
      <Text ff="monospace" size="sm" c="dimmed">
        {error instanceof Error ? error.message : String(error)}
      </Text>
      <Button onClick={() => window.location.reload()}>{t('pageError.reload')}</Button>
    </Stack>
  );
}

/** For addresses that lead nowhere. */
export function NoSuchPage() {
  const { t } = useTranslation('shell');
  return (
    <Stack align="flex-start">
      <Title order={1}>{t('noSuchPage.title')}</Title>
      <Button component={Link} to="/">
        {t('noSuchPage.back')}
      </Button>
    </Stack>
  );
}
