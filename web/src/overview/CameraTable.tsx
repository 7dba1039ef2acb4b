import { Table, Text } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import type { Camera } from '../gen/visionserver/v1/camera_pb';
import { formatNumber, kNone } from '../shell/format';
import { WideTable } from '../shell/WideTable';
import { StateMark } from '../shell/StateMark';
import { describeCameraState } from './states';

const count = (value: bigint | undefined) => (value === undefined ? kNone : formatNumber(value));

/** A counter of something bad: it stands out once it is not zero. */
function BadCount({ value }: { value: bigint | undefined }) {
  return <span style={{ color: value ? 'var(--vs-warning)' : undefined }}>{count(value)}</span>;
}

/** All cameras, live, with the counters that tell a bad network from a bad camera. */
export function CameraTable({ cameras }: { cameras: Camera[] }) {
  const { t } = useTranslation('overview');
  return (
    <WideTable label={t('cameras')}>
      <Table.Thead>
        <Table.Tr>
          <Table.Th>{t('camera')}</Table.Th>
          <Table.Th>{t('state')}</Table.Th>
          <Table.Th ta="right">{t('rate')}</Table.Th>
          <Table.Th ta="right">{t('frames')}</Table.Th>
          <Table.Th ta="right" title={t('lostHelp')}>
            {t('lost')}
          </Table.Th>
          <Table.Th ta="right" title={t('incompleteHelp')}>
            {t('incomplete')}
          </Table.Th>
          <Table.Th ta="right" title={t('resendsHelp')}>
            {t('resends')}
          </Table.Th>
          <Table.Th ta="right" title={t('reconnectsHelp')}>
            {t('reconnects')}
          </Table.Th>
          <Table.Th>{t('usedBy')}</Table.Th>
        </Table.Tr>
      </Table.Thead>
      <Table.Tbody>
        {cameras.map((camera) => {
          const described = describeCameraState(camera.state);
          const counters = camera.counters;
          return (
            <Table.Tr key={camera.id}>
              <Table.Td>
                <Text size="sm" fw={600} style={{ whiteSpace: 'nowrap' }}>
                  {camera.id}
                </Text>
                <Text size="xs" c="dimmed" title={camera.uri}>
                  {[camera.vendorModel, camera.serial].filter(Boolean).join(' · ')}
                </Text>
              </Table.Td>
              <Table.Td>
                <StateMark level={described.level} label={t(described.key)} />
                {camera.lastError && (
                  <Text size="xs" c="var(--vs-bad)" maw={420} style={{ overflowWrap: 'anywhere' }}>
                    {camera.lastError}
                  </Text>
                )}
              </Table.Td>
              <Table.Td ta="right">
                {counters ? formatNumber(counters.framesPerSecond, 1) : kNone}
              </Table.Td>
              <Table.Td ta="right">{count(counters?.frames)}</Table.Td>
              <Table.Td ta="right">
                <BadCount value={counters?.lost} />
              </Table.Td>
              <Table.Td ta="right">
                <BadCount value={counters?.incomplete} />
              </Table.Td>
              <Table.Td ta="right">
                {count(counters?.resendRequests)} / {count(counters?.resent)}
              </Table.Td>
              <Table.Td ta="right">
                <BadCount value={counters?.reconnects} />
              </Table.Td>
              <Table.Td>{camera.usedBy.join(', ') || kNone}</Table.Td>
            </Table.Tr>
          );
        })}
      </Table.Tbody>
    </WideTable>
  );
}
