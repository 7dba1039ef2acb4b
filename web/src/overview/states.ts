import { CameraState } from '../gen/visionserver/v1/camera_pb';
import { SequenceRunState } from '../gen/visionserver/v1/sequence_pb';
import type { Level } from './StateMark';

/** Key of the text, and how good or bad it is. */
export function describeRunState(state: SequenceRunState) {
  switch (state) {
    case SequenceRunState.STOPPED:
      return { key: 'runState.stopped', level: 'off' as Level } as const;
    case SequenceRunState.STARTING:
      return { key: 'runState.starting', level: 'busy' as Level } as const;
    case SequenceRunState.RUNNING:
      return { key: 'runState.running', level: 'good' as Level } as const;
    case SequenceRunState.DEGRADED:
      return { key: 'runState.degraded', level: 'warning' as Level } as const;
    case SequenceRunState.STOPPING:
      return { key: 'runState.stopping', level: 'busy' as Level } as const;
    case SequenceRunState.FAULT:
      return { key: 'runState.fault', level: 'bad' as Level } as const;
    default:
      return { key: 'unknown', level: 'off' as Level } as const;
  }
}

/** Key of the text, and how good or bad it is. */
export function describeCameraState(state: CameraState) {
  switch (state) {
    case CameraState.CLOSED:
      return { key: 'cameraState.closed', level: 'off' as Level } as const;
    case CameraState.OPENING:
      return { key: 'cameraState.opening', level: 'busy' as Level } as const;
    case CameraState.IDLE:
      return { key: 'cameraState.idle', level: 'off' as Level } as const;
    case CameraState.STREAMING:
      return { key: 'cameraState.streaming', level: 'good' as Level } as const;
    case CameraState.STALLED:
      return { key: 'cameraState.stalled', level: 'bad' as Level } as const;
    case CameraState.LOST:
      return { key: 'cameraState.lost', level: 'bad' as Level } as const;
    default:
      return { key: 'unknown', level: 'off' as Level } as const;
  }
}

/** Whether a sequence has an instance that can be stopped. */
export function isActive(state: SequenceRunState): boolean {
  return (
    state === SequenceRunState.STARTING ||
    state === SequenceRunState.RUNNING ||
    state === SequenceRunState.DEGRADED
  );
}
