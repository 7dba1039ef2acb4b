import { Alert, Button, Stack, Text } from '@mantine/core';
import { useQuery } from '@tanstack/react-query';
import { useCallback, useMemo } from 'react';
import { useTranslation } from 'react-i18next';

import { pageApi } from '../api/pageClients';
import { messageOf } from '../api/errors';
import type { GetResultFileResponse } from '../gen/visionserver/v1/result_pb';
import { download } from '../shell/download';
import { formatBytes } from '../shell/format';
import { Grey16Picture } from './Grey16Picture';
import { isGrey16 } from './png16';

/** The picture or point cloud that a field of a result names: shown if possible, else to save. */
export function ResultFile({ resultId, field }: { resultId: string; field: string }) {
  const { t } = useTranslation('results');
  const file = useQuery({
    queryKey: ['results', 'file', resultId, field],
    queryFn: ({ signal }) => pageApi.results.getResultFile({ resultId, field }, { signal }),
    staleTime: Infinity,
    gcTime: 0, // files are large
    retry: false,
  });
  if (file.isPending) return <Text role="status">{t('loading')}</Text>;
  if (file.isError) {
    return <Alert color="red">{t('fileFailed', { field, message: messageOf(file.error) })}</Alert>;
  }
  return <FileShown field={field} file={file.data} />;
}

function FileShown({ field, file }: { field: string; file: GetResultFileResponse }) {
  const { t } = useTranslation('results');
  const blob = useMemo(
    () => new Blob([file.data as Uint8Array<ArrayBuffer>], { type: file.mediaType }),
    [file],
  );
  return (
    <Stack gap="xs" align="start">
      {file.mediaType === 'image/png' &&
        (isGrey16(file.data) ? (
          <Grey16Picture file={file.data} label={field} />
        ) : (
          <Picture blob={blob} label={field} />
        ))}
      <Button variant="default" size="xs" onClick={() => download(file.fileName, blob)}>
        {t('download', { name: file.fileName })} ({formatBytes(blob.size)})
      </Button>
    </Stack>
  );
}

function Picture({ blob, label }: { blob: Blob; label: string }) {
  const show = useCallback(
    (picture: HTMLImageElement) => {
      picture.src = URL.createObjectURL(blob);
      return () => URL.revokeObjectURL(picture.src);
    },
    [blob],
  );
  return <img ref={show} alt={label} style={{ maxWidth: '100%' }} />;
}
