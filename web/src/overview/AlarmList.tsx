import { Group, Stack, Text } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { type Alarm, AlarmSeverity } from '../gen/visionserver/v1/system_pb';
import { formatTime } from '../shell/format';
import { CheckIcon } from '../shell/icons';
import { StateMark } from '../shell/StateMark';

/** What needs attention, gravest first; says so when nothing does. */
export function AlarmList({ alarms }: { alarms: Alarm[] }) {
  const { t } = useTranslation('overview');
  if (alarms.length === 0) {
    return (
      <Group gap="xs" c="var(--vs-good)">
        <CheckIcon />
        <Text size="sm">{t('noAlarms')}</Text>
      </Group>
    );
  }
  return (
    <Stack component="ul" gap="xs" m={0} p={0} style={{ listStyle: 'none' }}>
      {alarms.map((alarm) => {
        const grave = alarm.severity === AlarmSeverity.ERROR;
        return (
          <li key={alarm.id}>
            <Group gap="md" wrap="nowrap" align="flex-start">
              {/* As wide for all, so that the messages stand below each other. */}
              <div style={{ flex: 'none', width: '5.5rem' }}>
                <StateMark
                  level={grave ? 'bad' : 'warning'}
                  label={t(grave ? 'alarmError' : 'alarmWarning')}
                />
              </div>
              <div>
                <Text size="sm" style={{ overflowWrap: 'anywhere' }}>
                  <strong>{alarm.id}</strong>: {alarm.message}
                </Text>
                <Text size="xs" c="dimmed">
                  {t('since', { time: formatTime(alarm.since) })}
                </Text>
              </div>
            </Group>
          </li>
        );
      })}
    </Stack>
  );
}
