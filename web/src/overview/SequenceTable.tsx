import { Anchor, Table, Text } from '@mantine/core';
import { useQueryClient } from '@tanstack/react-query';
import { useTranslation } from 'react-i18next';
import { Link } from 'react-router';
import { mayOperate, useRole } from '../api/session';
import { formatNumber, kNone } from '../shell/format';
import { describeRunState } from '../shell/runState';
import { StartStop } from '../shell/StartStop';
import { StateMark } from '../shell/StateMark';
import { HiddenTh, WideTable } from '../shell/WideTable';
import type { SequenceRow } from './queries';

const ms = (us: number | undefined) => (us === undefined ? kNone : formatNumber(us / 1000, 1));

/** All stored sequences, live; operators start and stop them here. */
export function SequenceTable({ rows }: { rows: SequenceRow[] }) {
  const { t } = useTranslation(['overview', 'shell']);
  const operator = mayOperate(useRole());
  const client = useQueryClient();
  return (
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
                <StateMark level={described.level} label={t(described.key, { ns: 'shell' })} />
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
                {state ? formatNumber(state.framesPerSecond, 1) : kNone}
              </Table.Td>
              <Table.Td ta="right">{ms(state?.latencyP50Us)}</Table.Td>
              <Table.Td ta="right">{ms(state?.latencyP99Us)}</Table.Td>
              <Table.Td ta="right">
                {state?.latencyBudgetMs ? formatNumber(state.latencyBudgetMs, 1) : kNone}
                {state !== undefined && state.overBudget > 0n && (
                  <Text size="xs" c="var(--vs-warning)">
                    {t('overBudget', { number: formatNumber(state.overBudget) })}
                  </Text>
                )}
              </Table.Td>
              <Table.Td ta="right">{state ? formatNumber(state.frames) : kNone}</Table.Td>
              <Table.Td ta="right">{state ? formatNumber(state.dropped) : kNone}</Table.Td>
              <Table.Td ta="right">{state ? formatNumber(state.failed) : kNone}</Table.Td>
              {operator && (
                <Table.Td ta="right">
                  <StartStop
                    id={sequence.id}
                    state={runState}
                    size="xs"
                    onSettled={() => client.invalidateQueries({ queryKey: ['overview'] })}
                  />
                </Table.Td>
              )}
            </Table.Tr>
          );
        })}
      </Table.Tbody>
    </WideTable>
  );
}
