import { Title } from '@mantine/core';
import { useTranslation } from 'react-i18next';

export default function OverviewPage() {
  const { t } = useTranslation('overview');
  return <Title order={1}>{t('title')}</Title>;
}
