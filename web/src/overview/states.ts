import { CameraState } from '../gen/visionserver/v1/camera_pb';
import type { Level } from '../shell/StateMark';

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
