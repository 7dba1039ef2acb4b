import type {
  BlockSpec,
  BlockType,
  PortInfo,
  SequenceSpec,
} from '../../gen/visionserver/v1/sequence_pb';
import type { Output } from '../outputs';

/** A block as it is drawn. */
export interface GraphBlock {
  id: string;
  type: string;
  doc: string;
  inputs: PortInfo[];
  outputs: PortInfo[];
  /** What is seen of its work; undefined where it makes neither pictures nor maps. */
  preview: Output | undefined;
  x: number;
  y: number;
  height: number;
}

export const kWidthPx = 208;
export const kHeadPx = 44;
export const kPortPx = 18;
export const kPreviewPx = 124;
const kFootPx = 8;
const kGapPx = 28;

/** Blocks where the sequence's author put them, pulled apart until none covers another. */
export function blocksOf(spec: SequenceSpec, types: BlockType[], outputs: Output[]): GraphBlock[] {
  const blocks = spec.blocks.map((block) => blockOf(block, types, outputs));
  return spread(blocks);
}

/** Whether the author put the blocks anywhere: all at one place means nowhere. */
export function hasPlaces(spec: SequenceSpec): boolean {
  const places = new Set(spec.blocks.map(({ x, y }) => `${x} ${y}`));
  return places.size === spec.blocks.length;
}

function blockOf({ id, type, x, y }: BlockSpec, types: BlockType[], all: Output[]): GraphBlock {
  const { inputs = [], outputs = [], doc = '' } = types.find((one) => one.type === type) ?? {};
  const preview = all.find(({ path }) => path.startsWith(`${id}.`));
  const height =
    kHeadPx +
    Math.max(inputs.length, outputs.length) * kPortPx +
    (preview ? kPreviewPx : 0) +
    kFootPx;
  return { id, type, doc, inputs, outputs, preview, x, y, height };
}

/** Stretches both ways by no more than is needed. */
function spread(blocks: GraphBlock[]): GraphBlock[] {
  const columns = [...new Set(blocks.map(({ x }) => x))].sort((a, b) => a - b);
  const distances = columns.slice(1).map((x, i) => x - columns[i]!);
  const stretchX = Math.max(1, ...distances.map((distance) => (kWidthPx + 2 * kGapPx) / distance));
  let stretchY = 1;
  for (const a of blocks) {
    for (const b of blocks) {
      if (a.x === b.x && a.y < b.y) {
        stretchY = Math.max(stretchY, (a.height + kGapPx) / (b.y - a.y));
      }
    }
  }
  return blocks.map((block) => ({ ...block, x: block.x * stretchX, y: block.y * stretchY }));
}

const colors: Partial<Record<string, string>> = {
  stereo_frame: '#4dabf7',
  frame: '#4dabf7',
  grey_image: '#4dabf7',
  color_image: '#da77f2',
  disparity_map: '#ff922b',
  depth_map: '#51cf66',
  point_cloud: '#20c997',
  number: '#fcc419',
  integer: '#fcc419',
  bool: '#ff6b6b',
  string: '#f783ac',
};

/** CSS colour of what goes through a port. */
export const portColor = (type: string) => colors[type] ?? '#adb5bd';
