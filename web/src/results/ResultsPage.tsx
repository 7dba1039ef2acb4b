import { Title } from '@mantine/core';
import { useTranslation } from 'react-i18next';

export default function ResultsPage() {
  const { t } = useTranslation('results');
  return <Title order={1}>{t('title')}</Title>;
}
