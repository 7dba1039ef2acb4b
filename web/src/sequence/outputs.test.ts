// @vitest-environment node
import { create } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { BlockTypeSchema, SequenceSpecSchema } from '../gen/visionserver/v1/sequence_pb';
import { mainMap, mainPicture, outputsOf } from './outputs';

const port = (name: string, type: string) => ({ name, type });
const types = [
  { type: 'StereoCamera', outputs: [port('pair', 'stereo_frame')] },
  { type: 'RectifyPair', outputs: [port('rectified', 'stereo_frame')] },
  { type: 'SgmStereo', outputs: [port('disparity', 'disparity_map')] },
  { type: 'SpeckleFilter', outputs: [port('filtered', 'disparity_map')] },
  { type: 'DisparityToDepth', outputs: [port('depth', 'depth_map')] },
  { type: 'DisparityColors', outputs: [port('picture', 'color_image')] },
  { type: 'DepthQuality', outputs: [port('valid', 'number')] },
  { type: 'Publish' },
].map((type) => create(BlockTypeSchema, type));

const stereo = create(SequenceSpecSchema, {
  blocks: [
    { id: 'cameras', type: 'StereoCamera' },
    { id: 'colors', type: 'DisparityColors' },
    { id: 'filter', type: 'SpeckleFilter' },
    { id: 'match', type: 'SgmStereo' },
    {
      id: 'publish',
      type: 'Publish',
      parameters: { stream: { kind: { case: 'stringValue', value: 'depth' } } },
    },
    { id: 'quality', type: 'DepthQuality' },
    { id: 'rectify', type: 'RectifyPair' },
    { id: 'to_depth', type: 'DisparityToDepth' },
  ],
  connections: [
    { from: 'cameras.pair', to: 'rectify.pair' },
    { from: 'rectify.rectified', to: 'match.pair' },
    { from: 'match.disparity', to: 'filter.disparity' },
    { from: 'filter.filtered', to: 'publish.value' },
    { from: 'filter.filtered', to: 'colors.disparity' },
    { from: 'filter.filtered', to: 'to_depth.disparity' },
    { from: 'to_depth.depth', to: 'quality.depth' },
  ],
});

describe('outputs of a sequence', () => {
  const outputs = outputsOf('cell', stereo, types);

  it('are pictures and maps, by their published streams or else as taps', () => {
    expect(outputs.map(({ stream }) => stream)).toEqual([
      'cell/cameras.pair',
      'cell/colors.picture',
      'cell/depth',
      'cell/match.disparity',
      'cell/rectify.rectified',
      'cell/to_depth.depth',
    ]);
  });

  it('show first the disparity that is worked on most, beside the picture it is made from', () => {
    const map = mainMap(outputs, stereo);
    expect(map?.path).toBe('filter.filtered');
    expect(mainPicture(outputs, stereo, map)?.path).toBe('rectify.rectified');
  });

  it('show a picture alone where there is no map', () => {
    const spec = create(SequenceSpecSchema, { blocks: [{ id: 'left', type: 'StereoCamera' }] });
    const alone = outputsOf('cell', spec, types);
    expect(mainMap(alone, spec)).toBeUndefined();
    expect(mainPicture(alone, spec, undefined)?.path).toBe('left.pair');
  });
});
