import { Group, Text, Title } from '@mantine/core';
import { useQueryClient } from '@tanstack/react-query';
import { useTranslation } from 'react-i18next';
import type { SequenceState } from '../gen/visionserver/v1/sequence_pb';
import { describeRunState } from '../shell/runState';
import { StartStop } from '../shell/StartStop';
import { StateMark } from '../shell/StateMark';
import classes from './page.module.css';
import { StreamFigures } from './StreamFigures';
import { stateKey } from './useSequenceState';
import type { LiveScene } from './view/liveScene';

interface Props {
  id: string;
  description: string;
  state: SequenceState | undefined;
  scene: LiveScene;
}

/** What the sequence is, whether it runs, and what really reaches this screen. */
export function SequenceHeader({ id, description, state, scene }: Props) {
  const { t } = useTranslation('shell');
  const queries = useQueryClient();
  const { key, level } = describeRunState(state?.state);
  const error = state?.lastError;
  return (
    <>
      <Group gap="md" wrap="nowrap">
        <Title order={1}>{id}</Title>
        <StateMark level={level} label={t(key)} />
        {state && (
          <StartStop
            id={id}
            state={state.state}
            size="compact-sm"
            onSettled={(next) => next && queries.setQueryData(stateKey(id), next)}
          />
        )}
        <Text size="sm" c="dimmed" truncate flex={1} title={description}>
          {description}
        </Text>
        <StreamFigures scene={scene} />
      </Group>
      {error && (
        <p className={classes.lastError} role="status" data-testid="last-error">
          <strong>{error.path}</strong> {error.message}
        </p>
      )}
    </>
  );
}
