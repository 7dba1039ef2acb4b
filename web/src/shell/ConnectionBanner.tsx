import { Group, Loader, Text } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { useConnection } from '../api/connection';

/** Over every page while the server does not answer; goes by itself. */
export function ConnectionBanner() {
  const { t } = useTranslation('shell');
  const lost = useConnection((state) => state.lost);
  return (
    <div role="status" aria-live="assertive">
      {lost && (
        <Group
          pos="fixed"
          bottom={0}
          left={0}
          right={0}
          px="md"
          py="xs"
          gap="sm"
          bg="#ffc078"
          c="#241502"
          style={{ zIndex: 500 }}
        >
          <Loader size={16} color="#241502" />
          <Text size="sm" fw={600}>
            {t('connectionLost')}
          </Text>
        </Group>
      )}
    </div>
  );
}
