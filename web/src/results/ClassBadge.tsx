import { Badge } from '@mantine/core';
import { useTranslation } from 'react-i18next';

import type { ResultClass } from '../gen/visionserver/v1/result_pb';
import { classWords } from './filter';

// White on dark: enough contrast in both themes. The word tells what the colour tells.
const colors = { undefined: 'gray.7', pass: 'green.9', warn: 'orange.9', fail: 'red.9' };

/** The verdict about a part. */
export function ClassBadge({ resultClass }: { resultClass: ResultClass }) {
  const { t } = useTranslation('results');
  const word = classWords[resultClass];
  return (
    <Badge variant="filled" color={colors[word]} radius="sm">
      {t(`classes.${word}`)}
    </Badge>
  );
}
