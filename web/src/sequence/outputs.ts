import type {
  BlockType,
  Connection,
  PortInfo,
  SequenceSpec,
} from '../gen/visionserver/v1/sequence_pb';

/** An output of a block that can be looked at. */
export interface Output {
  /** "block.port". */
  path: string;
  kind: 'map' | 'picture';
  type: string;
  /** Where it can be subscribed to. */
  stream: string;
}

const kinds: Partial<Record<string, Output['kind']>> = {
  disparity_map: 'map',
  depth_map: 'map',
  grey_image: 'picture',
  color_image: 'picture',
  frame: 'picture',
  stereo_frame: 'picture',
};

const blockOf = (path: string) => path.split('.')[0]!;

/** All outputs that show something, in the order of the blocks. */
export function outputsOf(id: string, spec: SequenceSpec, types: BlockType[]): Output[] {
  const portsOf = (type: string): PortInfo[] =>
    types.find((one) => one.type === type)?.outputs ?? [];
  return spec.blocks.flatMap((block) =>
    portsOf(block.type).flatMap((port) => {
      const kind = kinds[port.type];
      if (!kind) return [];
      const path = `${block.id}.${port.name}`;
      return [{ path, kind, type: port.type, stream: streamOf(id, spec, path) }];
    }),
  );
}

/** The stream of an output: the published one, which others may watch too, else the tap. */
function streamOf(id: string, spec: SequenceSpec, path: string): string {
  for (const { from, to } of spec.connections) {
    if (from !== path) continue;
    const block = spec.blocks.find((one) => one.id === blockOf(to));
    const name = block?.type === 'Publish' && block.parameters['stream']?.kind;
    if (name && name.case === 'stringValue') return `${id}/${name.value}`;
  }
  return `${id}/${path}`;
}

/** The blocks that a block gets something from, nearest first, itself in front. */
function upstream(block: string, connections: Connection[]): string[] {
  const found = [block];
  for (const one of found) {
    for (const { from, to } of connections) {
      if (blockOf(to) === one && !found.includes(blockOf(from))) found.push(blockOf(from));
    }
  }
  return found;
}

/** The map to show first: a disparity map, the one that is worked on most; else a depth map. */
export function mainMap(outputs: Output[], { connections }: SequenceSpec): Output | undefined {
  const maps = outputs.filter(({ kind }) => kind === 'map');
  const disparities = maps.filter(({ type }) => type === 'disparity_map');
  const candidates = disparities.length > 0 ? disparities : maps;
  const depthOfWork = ({ path }: Output) => upstream(blockOf(path), connections).length;
  return [...candidates].sort((a, b) => depthOfWork(b) - depthOfWork(a))[0];
}

/** The picture that belongs to a map: the nearest that it is made from; else the first there is. */
export function mainPicture(
  outputs: Output[],
  { connections }: SequenceSpec,
  map: Output | undefined,
): Output | undefined {
  const pictures = outputs.filter(({ kind }) => kind === 'picture');
  if (!map) return pictures[0];
  for (const block of upstream(blockOf(map.path), connections)) {
    const found = pictures.find(({ path }) => blockOf(path) === block);
    if (found) return found;
  }
  return pictures[0];
}
