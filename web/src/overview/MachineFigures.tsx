import { Progress, SimpleGrid, Text } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { formatBytes, formatDuration, formatNumber } from '../shell/format';
import { useResources, useStatistics } from './queries';

// From here a figure is shown as a warning, and as bad.
const kWarningPart = 0.8;
const kBadPart = 0.95;

/** One figure: what it is, how much, a bar for the used part, and a line that explains. */
function Figure({
  label,
  value,
  part,
  detail,
}: {
  label: string;
  value: string;
  /** 0..1 of what there is. */
  part?: number;
  detail: string;
}) {
  const colour =
    part === undefined || part < kWarningPart
      ? 'var(--vs-good)'
      : part < kBadPart
        ? 'var(--vs-warning)'
        : 'var(--vs-bad)';
  return (
    <div className="vs-panel">
      <Text size="xs" c="dimmed">
        {label}
      </Text>
      <Text size="lg" fw={600}>
        {value}
      </Text>
      {part !== undefined && (
        <Progress value={100 * part} color={colour} size="sm" my={4} aria-label={label} />
      )}
      <Text size="xs" c="dimmed" style={{ overflowWrap: 'anywhere' }}>
        {detail}
      </Text>
    </div>
  );
}

const used = (total: bigint, free: bigint) => (total ? 1 - Number(free) / Number(total) : 0);

/** How much of the machine is used, and by whom. */
export function MachineFigures() {
  const { t } = useTranslation('overview');
  const resources = useResources().data;
  const statistics = useStatistics().data;
  if (!resources || !statistics) return null;
  const load = resources.load1min;
  const users = statistics.usersOnline;
  return (
    <SimpleGrid cols={{ base: 2, sm: 3, md: 5 }} spacing="sm">
      <Figure
        label={t('load')}
        value={formatNumber(load, 2)}
        part={Math.min(1, load / resources.cpuCores)}
        detail={t('loadDetail', { cores: resources.cpuCores })}
      />
      <Figure
        label={t('memory')}
        value={formatBytes(resources.memoryTotalBytes - resources.memoryAvailableBytes)}
        part={used(resources.memoryTotalBytes, resources.memoryAvailableBytes)}
        detail={t('memoryDetail', {
          total: formatBytes(resources.memoryTotalBytes),
          server: formatBytes(resources.memoryServerBytes),
        })}
      />
      <Figure
        label={t('disk')}
        value={formatBytes(resources.diskTotalBytes - resources.diskFreeBytes)}
        part={used(resources.diskTotalBytes, resources.diskFreeBytes)}
        detail={t('diskDetail', {
          total: formatBytes(resources.diskTotalBytes),
          free: formatBytes(resources.diskFreeBytes),
        })}
      />
      <Figure
        label={t('uptime')}
        value={formatDuration(Number(statistics.uptime?.seconds ?? 0))}
        detail={t('uptimeDetail', {
          connections: statistics.connections,
          streams: statistics.openStreams,
        })}
      />
      <Figure
        label={t('usersOnline')}
        value={formatNumber(users.length)}
        detail={users.join(', ') || t('nobody')}
      />
    </SimpleGrid>
  );
}
