import { Popover } from '@mantine/core';
import { useId, useState } from 'react';
import { useTranslation } from 'react-i18next';
import type { BlockState } from '../../gen/visionserver/v1/sequence_pb';
import classes from './graph.module.css';

/**
 * How often a block has failed since it was started, with the reason of the last time by pointing or
 * focus: what fails now and then is seen although the next frame is good. Muted while it works.
 */
export function FailureBadge({ block, failures, lastFailure, lastError }: BlockState) {
  const { t, i18n } = useTranslation('sequence');
  const id = useId();
  const [pointed, setPointed] = useState(false);
  const [focused, setFocused] = useState(false);
  if (failures === 0n) return null;
  const works = lastError === '';
  const number = new Intl.NumberFormat(i18n.language, { notation: 'compact' }).format(failures);
  return (
    <Popover opened={pointed || focused} withRoles={false} width="max-content" shadow="md">
      <Popover.Target>
        <button
          type="button"
          className={classes.failures}
          data-works={works}
          data-testid={`failures-${block}`}
          aria-label={t('graph.failures', { count: Number(failures), number })}
          aria-describedby={id}
          onPointerEnter={() => setPointed(true)}
          onPointerLeave={() => setPointed(false)}
          onFocus={() => setFocused(true)}
          onBlur={() => setFocused(false)}
        >
          <span aria-hidden="true">✕ </span>
          {number}
        </button>
      </Popover.Target>
      <Popover.Dropdown id={id} role="tooltip" className={classes.reason}>
        {works ? t('graph.worksAgain', { reason: lastFailure }) : lastFailure}
      </Popover.Dropdown>
    </Popover>
  );
}
