// @vitest-environment node
import { create } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { BlockTypeSchema, SequenceSpecSchema } from '../../gen/visionserver/v1/sequence_pb';
import { arrange } from './arrange';
import { blocksOf, type GraphBlock, hasPlaces, kWidthPx } from './graph';

const types = [
  create(BlockTypeSchema, {
    type: 'Camera',
    doc: 'Takes pictures.',
    outputs: [{ name: 'frame', type: 'frame' }],
  }),
  create(BlockTypeSchema, {
    type: 'Check',
    inputs: [{ name: 'a', type: 'any' }],
    outputs: [{ name: 'good', type: 'bool' }],
  }),
];
const specOf = (places: [string, number, number][]) =>
  create(SequenceSpecSchema, {
    blocks: places.map(([id, x, y]) => ({ id, type: id === 'left' ? 'Camera' : 'Check', x, y })),
    connections: [
      { from: 'left.frame', to: 'one.a' },
      { from: 'one.good', to: 'two.a' },
    ],
  });
const preview = { path: 'left.frame', kind: 'picture', type: 'frame', stream: 's/left.frame' } as const;

function overlaps(a: GraphBlock, b: GraphBlock): boolean {
  const apartX = a.x + kWidthPx <= b.x || b.x + kWidthPx <= a.x;
  const apartY = a.y + a.height <= b.y || b.y + b.height <= a.y;
  return a !== b && !apartX && !apartY;
}

describe('the blocks of a graph', () => {
  it('have what their types say, and a live picture where they make one', () => {
    const [left, one] = blocksOf(specOf([['left', 0, 0], ['one', 400, 0]]), types, [preview]);
    expect(left).toMatchObject({ doc: 'Takes pictures.', inputs: [], preview });
    expect(one).toMatchObject({ preview: undefined });
    expect(left!.height).toBeGreaterThan(one!.height);
  });

  it('stay where the author put them when there is room', () => {
    const spec = specOf([['left', 0, 0], ['one', 400, 0], ['two', 400, 300]]);
    const places = blocksOf(spec, types, [preview]).map(({ x, y }) => [x, y]);
    expect(places).toEqual([[0, 0], [400, 0], [400, 300]]);
  });

  it('are pulled apart when they would cover each other', () => {
    const spec = specOf([['left', 0, 120], ['one', 100, 0], ['two', 100, 60]]);
    const blocks = blocksOf(spec, types, [preview]);
    expect(blocks.some((a) => blocks.some((b) => overlaps(a, b)))).toBe(false);
    expect(blocks[1]!.y).toBe(0);
    expect(blocks[2]!.y).toBeGreaterThan(60);
  });

  it('are arranged along their connections when nobody placed them', () => {
    const spec = specOf([['left', 0, 0], ['one', 0, 0], ['two', 0, 0]]);
    expect(hasPlaces(spec)).toBe(false);
    const blocks = arrange(blocksOf(spec, types, [preview]), spec.connections);
    expect(blocks[0]!.x + kWidthPx).toBeLessThan(blocks[1]!.x);
    expect(blocks[1]!.x + kWidthPx).toBeLessThan(blocks[2]!.x);
  });
});
