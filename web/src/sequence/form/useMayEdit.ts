import { mayEngineer, mayOperate, useRole } from '../../api/session';
import type { ParameterInfo } from '../../gen/visionserver/v1/sequence_pb';

/** Whether a parameter may be changed now, and if not, why: the name of a text. */
export type MayEdit = 'yes' | 'viewer' | 'engineersOnly' | 'stopFirst';

/** For the role of who is logged in; the server decides in the end. */
export function useMayEdit(running: boolean): (info: ParameterInfo) => MayEdit {
  const role = useRole();
  return (info) => {
    if (!mayOperate(role)) return 'viewer';
    if (!info.operatorEditable && !mayEngineer(role)) return 'engineersOnly';
    if (info.fixedWhileRunning && running) return 'stopFirst';
    return 'yes';
  };
}
