import '@xyflow/react/dist/style.css';
import { useComputedColorScheme } from '@mantine/core';
import { Background, Controls, type Edge, ReactFlow } from '@xyflow/react';
import { type KeyboardEvent, useMemo } from 'react';
import { useTranslation } from 'react-i18next';
import type { BlockType, SequenceSpec, SequenceState } from '../../gen/visionserver/v1/sequence_pb';
import type { Output } from '../outputs';
import { arrange } from './arrange';
import { BlockNode, type BlockNodeType, BlockStates } from './BlockNode';
import { blocksOf, type GraphBlock, hasPlaces, portColor, kWidthPx } from './graph';
import classes from './graph.module.css';

interface Props {
  spec: SequenceSpec;
  blockTypes: BlockType[];
  outputs: Output[];
  state: SequenceState | undefined;
  /** A block was chosen by a click, Enter or the space bar. */
  onChoose: (block: string) => void;
}

const nodeTypes = { block: BlockNode };

/** The blocks of a sequence and how they are connected, with what they are doing. */
export default function GraphPanel({ spec, blockTypes, outputs, state, onChoose }: Props) {
  const { t } = useTranslation('sequence');
  const colorMode = useComputedColorScheme('dark');
  const { nodes, edges } = useMemo(() => {
    const placed = blocksOf(spec, blockTypes, outputs);
    const blocks = hasPlaces(spec) ? placed : arrange(placed, spec.connections);
    return { nodes: blocks.map(nodeOf), edges: edgesOf(spec, blocks) };
  }, [spec, blockTypes, outputs]);
  const states = useMemo(
    () => new Map(state?.blocks.map((block) => [block.block, block])),
    [state],
  );
  return (
    <div className={classes.graph} data-testid="graph">
      <BlockStates value={states}>
        <ReactFlow
          nodes={nodes}
          edges={edges}
          nodeTypes={nodeTypes}
          colorMode={colorMode}
          aria-label={t('graph.label')}
          fitView
          minZoom={0.2}
          maxZoom={2}
          nodesDraggable={false}
          nodesConnectable={false}
          edgesFocusable={false}
          onlyRenderVisibleElements
          onNodeClick={(_, node) => onChoose(node.id)}
          onKeyDown={(event) => {
            const block = chosenBy(event);
            if (block !== undefined) onChoose(block);
          }}
        >
          <Background />
          <Controls showInteractive={false} />
        </ReactFlow>
      </BlockStates>
    </div>
  );
}

/** The focused block on which Enter or the space bar was pressed. */
function chosenBy({ key, target }: KeyboardEvent): string | undefined {
  if (key !== 'Enter' && key !== ' ') return undefined;
  const isBlock = target instanceof HTMLElement && target.matches('.react-flow__node');
  return isBlock ? target.dataset.id : undefined;
}

function nodeOf(block: GraphBlock): BlockNodeType {
  return {
    id: block.id,
    type: 'block',
    position: { x: block.x, y: block.y },
    width: kWidthPx,
    height: block.height,
    data: { block },
    ariaLabel: `${block.id}, ${block.type}`,
  };
}

function edgesOf(spec: SequenceSpec, blocks: GraphBlock[]): Edge[] {
  return spec.connections.map(({ from, to }) => {
    const [source = '', sourceHandle = ''] = from.split('.');
    const [target = '', targetHandle = ''] = to.split('.');
    const port = blocks
      .find(({ id }) => id === source)
      ?.outputs.find(({ name }) => name === sourceHandle);
    const style = { stroke: portColor(port?.type ?? ''), strokeWidth: 2 };
    return { id: `${from} ${to}`, source, sourceHandle, target, targetHandle, style };
  });
}
