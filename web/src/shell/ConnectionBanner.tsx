import { Alert, Loader } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { useConnection } from '../api/connection';

/** Over every page while the server does not answer; goes by itself. */
export function ConnectionBanner() {
  const { t } = useTranslation('shell');
  const lost = useConnection((state) => state.lost);
  return (
    <div role="status" aria-live="assertive">
      {lost && (
        <Alert
          color="orange"
          variant="filled"
          radius={0}
          py={6}
          icon={<Loader size={16} color="currentColor" />}
          pos="fixed"
          bottom={0}
          left={0}
          right={0}
          style={{ zIndex: 500 }}
        >
          {t('connectionLost')}
        </Alert>
      )}
    </div>
  );
}
