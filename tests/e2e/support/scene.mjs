// The simulated scene, standing still, with its exact truth; and sequences to look at.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

import { build } from './tools.mjs';

/** Puts the pair into `folder`; gives its geometry and truth. 648 x 483 pixels, with a binning of 2. */
export function writeScene(folder, binning = 2) {
  const truth = join(build, 'tests', 'e2e', 'e2e_scene_truth');
  const geometry = JSON.parse(execFileSync(truth, [folder, String(binning)], { encoding: 'utf8' }));
  const bytes = readFileSync(join(folder, 'disparity.f32'));
  const disparity_px = new Float32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
  const depth_m = (x, y) =>
    (geometry.focal_px * geometry.baseline_m) /
    (disparity_px[y * geometry.width + x] + geometry.offset_px);
  return { ...geometry, disparity_px, depth_m, grey: greyOf(join(folder, 'left.pgm')) };
}

/** The grey at (x, y) of a binary PGM file. */
function greyOf(file) {
  const bytes = readFileSync(file);
  const [header, width] = bytes.toString('latin1', 0, 40).match(/^P5\s+(\d+)\s+\d+\s+255\s/);
  return (x, y) => bytes[header.length + y * Number(width) + x];
}

const block = (id, type, params = {}) => ({ id, type, params, x: 0, y: 0 });
const connections = (lines) => lines.map(([from, to]) => ({ from, to }));

/** Depth of the still scene in `folder`, over and over. */
export function stillSequence(folder, geometry, { rate_hz = 5, match = {} } = {}) {
  const { focal_px, baseline_m, center_x_px, center_y_px, offset_px } = geometry;
  return depthSequence(
    'FileSource',
    { folder, rate_hz, loop: true, rectified: true, focal_px, baseline_m, center_x_px, center_y_px, offset_px },
    match,
  );
}

/** Only what depth on the screen needs, as cheap as it can be: for measuring what comes after it. */
export function cheapSequence(folder, geometry, { rate_hz, disparities = 128 }) {
  const match = { preset: 'single_pass', num_disparities: disparities };
  const { blocks, connections, ...rest } = stillSequence(folder, geometry, { rate_hz, match });
  const kept = ['cameras', 'match', 'publish_depth'];
  return {
    ...rest,
    blocks: blocks.filter(({ id }) => kept.includes(id)),
    connections: connections.filter(({ to }) => kept.includes(to.split('.')[0])),
  };
}

/** Depth of the moving scene. */
export function liveSequence({ rate_hz = 10, match = {} } = {}) {
  return depthSequence('SimulatedStereo', { rate_hz }, match);
}

function depthSequence(source, params, match) {
  return {
    description: 'Two pictures to depth, measured and judged.',
    max_frames_in_flight: 2,
    priority: 0,
    blocks: [
      block('cameras', source, params),
      block('match', 'SgmStereo', { num_disparities: 128, ...match }),
      block('publish_depth', 'Publish', { stream: 'depth' }),
      block('quality', 'DepthQuality'),
      block('judge', 'RangeCheck', { limits: 'min', min: 50 }),
      block('save', 'SaveImages', {
        policy: 'every_nth',
        every_nth: 50,
        max_files: 20,
        min_free_mb: 0,
        when_full: 'delete_oldest',
      }),
      block('log', 'LogResult', { name_a: 'valid_percent' }),
    ],
    connections: connections([
      ['cameras.pair', 'match.pair'],
      ['match.disparity', 'publish_depth.value'],
      ['match.disparity', 'quality.disparity'],
      ['match.disparity', 'save.picture'],
      ['quality.valid', 'judge.value'],
      ['quality.valid', 'log.a'],
      ['save.path', 'log.picture'],
      ['judge.result_class', 'log.result_class'],
    ]),
  };
}
