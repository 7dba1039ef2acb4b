import { Title } from '@mantine/core';
import { useTranslation } from 'react-i18next';

export default function SequencePage() {
  const { t } = useTranslation('sequence');
  return <Title order={1}>{t('title')}</Title>;
}
