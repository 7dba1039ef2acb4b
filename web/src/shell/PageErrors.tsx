import { Button, Stack, Text, Title } from '@mantine/core';
import { Component, type ReactNode } from 'react';
import { useTranslation } from 'react-i18next';
import { Link } from 'react-router';

function PageError({ error }: { error: Error }) {
  const { t } = useTranslation('shell');
  return (
    <Stack align="flex-start" role="alert">
      <Title order={1}>{t('pageError.title')}</Title>
      <Text>{t('pageError.text')}</Text>
      <Text ff="monospace" size="sm" c="dimmed">
        {error.message}
      </Text>
      <Button onClick={() => window.location.reload()}>{t('pageError.reload')}</Button>
    </Stack>
  );
}

/** Shows what went wrong in place of a page that failed, and leaves the others alone. */
export class PageBoundary extends Component<{ children: ReactNode }, { error?: Error }> {
  override state: { error?: Error } = {};

  static getDerivedStateFromError(thrown: unknown) {
    return { error: thrown instanceof Error ? thrown : new Error(String(thrown)) };
  }

  override render() {
    return this.state.error ? <PageError error={this.state.error} /> : this.props.children;
  }
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
