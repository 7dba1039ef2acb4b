import { Button, Group, Text } from '@mantine/core';
import { useEffect, useRef, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { pageApi } from '../api/pageClients';
import { messageOf } from '../api/errors';
import { download } from '../shell/download';
import { formatBytes } from '../shell/format';
import { csvName, gatherCsv } from './csv';
import { toFilter, type Selection } from './filter';

/** Saves all selected results, up to now, as one CSV file. */
export function ExportButton({ selection }: { selection: Selection }) {
  const { t } = useTranslation('results');
  const [bytes, setBytes] = useState<number>();
  const [failure, setFailure] = useState('');
  const running = useRef<AbortController>(null);
  // Whoever leaves the page waits for no answer.
  useEffect(() => () => running.current?.abort(), []);

  const start = async () => {
    const controller = new AbortController();
    running.current = controller;
    setFailure('');
    setBytes(0);
    try {
      const now = new Date();
      const pieces = pageApi.results.exportResults(
        { filter: toFilter(selection, now.getTime()) },
        { signal: controller.signal },
      );
      download(csvName(now), await gatherCsv(pieces, setBytes));
    } catch (error) {
      if (!controller.signal.aborted) setFailure(messageOf(error));
    } finally {
      setBytes(undefined);
    }
  };

  return (
    <Group gap="sm">
      <Text role="status" size="sm">
        {bytes !== undefined && t('exporting', { size: formatBytes(bytes) })}
      </Text>
      {failure !== '' && (
        <Text role="alert" size="sm">
          {t('exportFailed', { message: failure })}
        </Text>
      )}
      {bytes === undefined ? (
        <Button variant="default" onClick={() => void start()}>
          {t('export')}
        </Button>
      ) : (
        <Button variant="default" onClick={() => running.current?.abort()}>
          {t('cancel')}
        </Button>
      )}
    </Group>
  );
}
