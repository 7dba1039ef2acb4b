import { useEffect, useState, useSyncExternalStore } from 'react';
import { api } from '../../api/clients';
import { messageOf } from '../../api/errors';
import { type Field, type ParameterCalls, ParameterEditor } from './parameterEditor';
import { valueOf } from './value';

// Changes by others appear within this time. A stream of them would be the tab's second one.
const kPeriodMs = 1500;

/** The editor of a sequence's parameters, kept up to date while the tab is visible. */
export function useParameterEditor(sequence: string): ParameterEditor {
  const [editor] = useState(() => new ParameterEditor(callsOf(sequence)));
  useEffect(() => {
    let asking = false;
    const look = async () => {
      if (asking || document.visibilityState !== 'visible') return;
      asking = true;
      // A failure shows elsewhere on the page, and the next attempt is near.
      await editor.load().catch(() => undefined);
      asking = false;
    };
    void look();
    const timer = setInterval(() => void look(), kPeriodMs);
    return () => clearInterval(timer);
  }, [editor]);
  return editor;
}

/** Paths of all parameters; empty until they are known. */
export function usePaths(editor: ParameterEditor): readonly string[] {
  return useSyncExternalStore(editor.changed.on, editor.paths);
}

export function useField(editor: ParameterEditor, path: string): Field | undefined {
  return useSyncExternalStore(editor.changed.on, () => editor.field(path));
}

function callsOf(sequence: string): ParameterCalls {
  return {
    list: async () => (await api.parameters.listParameters({ sequence })).parameters,
    set: (path, info, value) => {
      const values = [{ path, value: valueOf(info.type, value) }];
      return api.parameters.setParameters({ sequence, values });
    },
    reset: (paths) => api.parameters.resetParameters({ sequence, paths }),
    // Of all faults the one that is about this parameter; its name is beside the text already.
    textOf: (error, path) => {
      const lines = messageOf(error).split('\n');
      const own = lines.find((line) => line.startsWith(`${path}: `));
      return own?.slice(path.length + 2) ?? lines.join('\n');
    },
  };
}
