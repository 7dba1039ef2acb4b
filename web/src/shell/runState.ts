import { SequenceRunState } from '../gen/visionserver/v1/sequence_pb';
import type { Level } from './StateMark';

const described = {
  [SequenceRunState.UNSPECIFIED]: ['unknown', 'off'],
  [SequenceRunState.STOPPED]: ['stopped', 'off'],
  [SequenceRunState.STARTING]: ['starting', 'busy'],
  [SequenceRunState.RUNNING]: ['running', 'good'],
  [SequenceRunState.DEGRADED]: ['degraded', 'warning'],
  [SequenceRunState.STOPPING]: ['stopping', 'busy'],
  [SequenceRunState.FAULT]: ['fault', 'bad'],
} as const satisfies Record<SequenceRunState, readonly [string, Level]>;

/** Key of a state's name in the shell's texts, and how good or bad it is. */
export function describeRunState(state = SequenceRunState.UNSPECIFIED) {
  // A newer server may know more states than this page.
  const [name, level] = described[state] ?? described[SequenceRunState.UNSPECIFIED];
  return { key: `runState.${name}`, level } as const;
}

/** Has an instance that can be stopped. */
export function mayBeStopped(state: SequenceRunState | undefined): boolean {
  return (
    state === SequenceRunState.STARTING ||
    state === SequenceRunState.RUNNING ||
    state === SequenceRunState.DEGRADED
  );
}

/** Has blocks, which keep what is set only while there are none. */
export function hasBlocks(state: SequenceRunState | undefined): boolean {
  return mayBeStopped(state) || state === SequenceRunState.STOPPING;
}
