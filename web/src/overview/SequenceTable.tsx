import { Anchor, Button, Table, Text } from '@mantine/core';
import { useState } from 'react';
import { useTranslation } from 'react-i18next';
import { Link } from 'react-router';
import { mayOperate, useRole } from '../api/session';
import { SequenceRunState } from '../gen/visionserver/v1/sequence_pb';
import { ConfirmDialog } from '../shell/ConfirmDialog';
import { formatNumber, none } from '../shell/format';
import { PlayIcon, StopIcon } from '../shell/icons';
import { HiddenTh, WideTable } from '../shell/WideTable';
import { type SequenceRow, useSetRunning } from './queries';
import { StateMark } from './StateMark';
import { describeRunState, isActive } from './states';

const ms = (us: number | undefined) => (us === undefined ? none : formatNumber(us / 1000, 1));

/** All stored sequences, live; operators start and stop them here. */
export function SequenceTable({ rows }: { rows: SequenceRow[] }) {
  const { t } = useTranslation('overview');
  const operator = mayOperate(useRole());
  const setRunning = useSetRunning();
  const [stopping, setStopping] = useState<string>();
  const busy = (id: string) => setRunning.isPending && setRunning.variables.id === id;
  return (
    <>
      <WideTable label={t('sequences')}>
        <Table.Thead>
          <Table.Tr>
            <Table.Th>{t('sequence')}</Table.Th>
            <Table.Th>{t('state')}</Table.Th>
            <Table.Th ta="right">{t('rate')}</Table.Th>
            <Table.Th ta="right">{t('latencyP50')}</Table.Th>
            <Table.Th ta="right">{t('latencyP99')}</Table.Th>
            <Table.Th ta="right" title={t('budgetHelp')}>
              {t('budget')}
            </Table.Th>
            <Table.Th ta="right">{t('frames')}</Table.Th>
            <Table.Th ta="right">{t('dropped')}</Table.Th>
            <Table.Th ta="right">{t('failed')}</Table.Th>
            {operator && <HiddenTh>{t('startOrStop')}</HiddenTh>}
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {rows.map(({ sequence, state }) => {
            const runState = state?.state ?? sequence.runState;
            const described = describeRunState(runState);
            return (
              <Table.Tr key={sequence.id}>
                <Table.Td>
                  <Anchor component={Link} to={`/sequence/${sequence.id}`} fw={600} size="sm">
                    {sequence.id}
                  </Anchor>
                  {sequence.autostart && (
                    <Text size="xs" c="dimmed">
                      {t('autostart')}
                    </Text>
                  )}
                </Table.Td>
                <Table.Td>
                  <StateMark level={described.level} label={t(described.key)} />
                  {state?.lastError && (
                    <Text
                      size="xs"
                      c="var(--vs-bad)"
                      maw={420}
                      style={{ overflowWrap: 'anywhere' }}
                    >
                      {state.lastError.path}: {state.lastError.message}
                    </Text>
                  )}
                </Table.Td>
                <Table.Td ta="right">
                  {state ? formatNumber(state.framesPerSecond, 1) : none}
                </Table.Td>
                <Table.Td ta="right">{ms(state?.latencyP50Us)}</Table.Td>
                <Table.Td ta="right">{ms(state?.latencyP99Us)}</Table.Td>
                <Table.Td ta="right">
                  {state?.latencyBudgetMs ? formatNumber(state.latencyBudgetMs, 1) : none}
                  {state !== undefined && state.overBudget > 0n && (
                    <Text size="xs" c="var(--vs-warning)">
                      {t('overBudget', { number: formatNumber(state.overBudget) })}
                    </Text>
                  )}
                </Table.Td>
                <Table.Td ta="right">{state ? formatNumber(state.frames) : none}</Table.Td>
                <Table.Td ta="right">{state ? formatNumber(state.dropped) : none}</Table.Td>
                <Table.Td ta="right">{state ? formatNumber(state.failed) : none}</Table.Td>
                {operator && (
                  <Table.Td ta="right">
                    {isActive(runState) ? (
                      <Button
                        size="xs"
                        variant="default"
                        leftSection={<StopIcon />}
                        loading={busy(sequence.id)}
                        onClick={() => setStopping(sequence.id)}
                        aria-label={t('stopNamed', { name: sequence.id })}
                      >
                        {t('stop')}
                      </Button>
                    ) : (
                      <Button
                        size="xs"
                        leftSection={<PlayIcon />}
                        loading={busy(sequence.id)}
                        disabled={runState === SequenceRunState.STOPPING}
                        onClick={() => setRunning.mutate({ id: sequence.id, run: true })}
                        aria-label={t('startNamed', { name: sequence.id })}
                      >
                        {t('start')}
                      </Button>
                    )}
                  </Table.Td>
                )}
              </Table.Tr>
            );
          })}
        </Table.Tbody>
      </WideTable>
      <ConfirmDialog
        opened={stopping !== undefined}
        title={t('stopTitle', { name: stopping ?? '' })}
        text={t('stopText')}
        action={t('stop')}
        onConfirm={() => {
          if (stopping) setRunning.mutate({ id: stopping, run: false });
          setStopping(undefined);
        }}
        onCancel={() => setStopping(undefined)}
      />
    </>
  );
}
