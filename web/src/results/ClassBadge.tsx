import { Badge } from '@mantine/core';
import { useTranslation } from 'react-i18next';

import type { ResultClass } from '../gen/visionserver/v1/result_pb';
import { classWords } from './filter';

// White has a contrast of at least 5 : 1 on each. The word tells what the colour tells.
const colors = { undefined: '#495057', pass: '#1b6e2d', warn: '#9a3d00', fail: '#b02525' };

/** The verdict about a part. */
export function ClassBadge({ resultClass }: { resultClass: ResultClass }) {
  const { t } = useTranslation('results');
  const word = classWords[resultClass];
  return (
    <Badge variant="filled" color={colors[word]} radius="sm" miw="max-content">
      {t(`classes.${word}`)}
    </Badge>
  );
}
