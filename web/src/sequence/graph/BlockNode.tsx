import { Handle, type Node, type NodeProps, Position } from '@xyflow/react';
import { createContext, memo, useContext } from 'react';
import { useTranslation } from 'react-i18next';
import type { BlockState, PortInfo } from '../../gen/visionserver/v1/sequence_pb';
import { number } from '../view/format';
import { FailureBadge } from './FailureBadge';
import { type GraphBlock, kHeadPx, kPortPx, portColor } from './graph';
import classes from './graph.module.css';
import { Preview } from './Preview';

export type BlockNodeType = Node<{ block: GraphBlock }, 'block'>;

/** What each block is doing, by its id; changes once a second. */
export const BlockStates = createContext<ReadonlyMap<string, BlockState>>(new Map());

/** One block: name, time of a run, ports, a live picture of its work, and what is wrong with it. */
export const BlockNode = memo(function BlockNode({ data: { block } }: NodeProps<BlockNodeType>) {
  const { t, i18n } = useTranslation('sequence');
  const state = useContext(BlockStates).get(block.id);
  const error = state?.lastError ?? '';
  return (
    <div className={classes.block} data-failed={error !== ''} title={block.doc}>
      <div className={classes.head} style={{ height: kHeadPx }}>
        <div className={classes.names}>
          <strong>{block.id}</strong>
          <span>{block.type}</span>
        </div>
        {state && <FailureBadge {...state} />}
        {state && state.runs > 0n && (
          <span className={classes.time} title={t('graph.time')} data-testid={`time-${block.id}`}>
            {number(state.p50Us / 1000, state.p50Us < 9950 ? 1 : 0, i18n.language)} ms
          </span>
        )}
      </div>
      <div className={classes.ports}>
        <Ports ports={block.inputs} side="in" />
        <Ports ports={block.outputs} side="out" />
      </div>
      {block.preview && <Preview output={block.preview} />}
      {error && (
        <div className={classes.error} role="status" title={error}>
          {error}
        </div>
      )}
    </div>
  );
});

function Ports({ ports, side }: { ports: PortInfo[]; side: 'in' | 'out' }) {
  return (
    <ul className={side === 'in' ? classes.inputs : classes.outputs}>
      {ports.map((port, i) => (
        <li key={port.name} style={{ height: kPortPx }} title={`${port.type}: ${port.doc}`}>
          {port.name}
          <Handle
            type={side === 'in' ? 'target' : 'source'}
            position={side === 'in' ? Position.Left : Position.Right}
            id={port.name}
            isConnectable={false}
            style={{ top: kHeadPx + (i + 0.5) * kPortPx, background: portColor(port.type) }}
          />
        </li>
      ))}
    </ul>
  );
}
