import dagre from '@dagrejs/dagre';
import type { Connection } from '../../gen/visionserver/v1/sequence_pb';
import { type GraphBlock, kWidthPx } from './graph';

/** Places for blocks that have none: from left to right along the connections. */
export function arrange(blocks: GraphBlock[], connections: Connection[]): GraphBlock[] {
  const graph = new dagre.graphlib.Graph();
  graph.setGraph({ rankdir: 'LR', nodesep: 28, ranksep: 56 });
  graph.setDefaultEdgeLabel(() => ({}));
  for (const { id, height } of blocks) graph.setNode(id, { width: kWidthPx, height });
  for (const { from, to } of connections) graph.setEdge(from.split('.')[0]!, to.split('.')[0]!);
  dagre.layout(graph);
  return blocks.map((block) => {
    // The middle of the block.
    const { x, y } = graph.node(block.id) as { x: number; y: number };
    return { ...block, x: x - kWidthPx / 2, y: y - block.height / 2 };
  });
}
