import { Badge, Group, Text, Title } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { SequenceRunState, type SequenceState } from '../gen/visionserver/v1/sequence_pb';
import classes from './page.module.css';
import { StartStop } from './StartStop';
import { StreamFigures } from './StreamFigures';
import type { LiveScene } from './view/liveScene';

interface Props {
  id: string;
  description: string;
  state: SequenceState | undefined;
  scene: LiveScene;
}

const states = {
  [SequenceRunState.UNSPECIFIED]: ['unknown', 'gray'],
  [SequenceRunState.STOPPED]: ['stopped', 'gray'],
  [SequenceRunState.STARTING]: ['starting', 'blue'],
  [SequenceRunState.RUNNING]: ['running', 'green'],
  [SequenceRunState.DEGRADED]: ['degraded', 'yellow'],
  [SequenceRunState.STOPPING]: ['stopping', 'blue'],
  [SequenceRunState.FAULT]: ['fault', 'red'],
} as const;

/** What the sequence is, whether it runs, and what really reaches this screen. */
export function SequenceHeader({ id, description, state, scene }: Props) {
  const { t } = useTranslation('sequence');
  const [name, color] = states[state?.state ?? SequenceRunState.UNSPECIFIED];
  const error = state?.lastError;
  return (
    <>
      <Group gap="md" wrap="nowrap">
        <Title order={1}>{id}</Title>
        {/* The border has the colour; green or yellow text could not be read on white. */}
        <Badge color={color} variant="outline" c="var(--mantine-color-text)" data-testid="run-state" miw={90}>
          {t(`state.${name}`)}
        </Badge>
        <StartStop id={id} state={state} />
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
