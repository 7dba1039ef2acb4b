import { Badge, Group, Text, Title, Tooltip } from '@mantine/core';
import { useQuery } from '@tanstack/react-query';
import { useTranslation } from 'react-i18next';
import { api } from '../api/clients';
import { SequenceRunState } from '../gen/visionserver/v1/sequence_pb';
import { number } from './view/format';
import type { LiveScene } from './view/liveScene';
import { useEvery } from './view/useEvery';

interface Props {
  id: string;
  description: string;
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
export function SequenceHeader({ id, description, scene }: Props) {
  const { t } = useTranslation('sequence');
  const { data: state } = useQuery({
    queryKey: ['sequence-state', id],
    queryFn: () => api.sequences.getSequenceState({ id }),
    refetchInterval: 1000,
  });
  const [name, color] = states[state?.state ?? SequenceRunState.UNSPECIFIED];
  return (
    <Group gap="md" wrap="nowrap">
      <Title order={1} size="h3">
        {id}
      </Title>
      <Badge color={color} variant="light" data-testid="run-state">
        {t(`state.${name}`)}
      </Badge>
      <Text size="sm" c="dimmed" truncate flex={1}>
        {description}
      </Text>
      <StreamFigures scene={scene} />
    </Group>
  );
}

/** Rate, delay and losses of what is on the screen: of the map, or of the picture where none is. */
function StreamFigures({ scene }: { scene: LiveScene }) {
  const { t, i18n } = useTranslation('sequence');
  const shown = useEvery(500, () => {
    const figures = scene.figures('map') ?? scene.figures('picture');
    if (!figures) return undefined;
    const { fps, latency_ms, dropped } = figures;
    return {
      fps: number(fps, 1, i18n.language),
      latency: latency_ms === undefined ? '–' : `${number(latency_ms, 0, i18n.language)} ms`,
      dropped: String(dropped),
    };
  });
  if (!shown) return null;
  const figure = (label: string, value: string, help: string, testId: string) => (
    <Tooltip label={help}>
      <Text size="sm" component="span" data-testid={testId} style={{ whiteSpace: 'nowrap' }}>
        <Text span c="dimmed" size="xs">
          {label}{' '}
        </Text>
        {value}
      </Text>
    </Tooltip>
  );
  return (
    <Group gap="md" wrap="nowrap">
      {figure(t('figures.fps'), shown.fps, t('figures.fps'), 'fps')}
      {figure(t('figures.latency'), shown.latency, t('figures.latencyHelp'), 'latency')}
      {figure(t('figures.dropped'), shown.dropped, t('figures.droppedHelp'), 'dropped')}
    </Group>
  );
}
