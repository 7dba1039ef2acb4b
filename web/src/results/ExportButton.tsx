import { Button, Group, Text } from '@mantine/core';
import { useEffect, useRef, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { acrossLogins } from '../api/acrossLogins';
import { pageApi } from '../api/pageClients';
import { messageOf } from '../api/errors';
import { download } from '../shell/download';
import { formatBytes } from '../shell/format';
import { csvName, gatherCsv } from './csv';
import { toFilter, type Selection } from './filter';

/** Saves all selected results, up to now, as one CSV file; begins again after a new login. */
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
    const { signal } = controller;
    setFailure('');
    try {
      const now = new Date();
      const filter = toFilter(selection, now.getTime());
      const csv = await acrossLogins(() => {
        setBytes(0);
        return gatherCsv(pageApi.results.exportResults({ filter }, { signal }), setBytes);
      }, signal);
      download(csvName(now), csv);
    } catch (error) {
      if (!signal.aborted) setFailure(messageOf(error));
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
