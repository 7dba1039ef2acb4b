import { create } from 'zustand';
import { persist } from 'zustand/middleware';
import type { ColorMap } from './colorMap';

/** How pictures and maps are shown; each browser remembers it. */
export interface Display {
  colorMap: ColorMap;
  /** Colours from `near_m` to `far_m`; undefined: as the map has it. */
  fixedRange: { near_m: number; far_m: number } | undefined;
  /** Invalid pixels coloured by their reason. */
  showReasons: boolean;
}

interface DisplayStore extends Display {
  set: (change: Partial<Display>) => void;
}

export const useDisplay = create<DisplayStore>()(
  persist(
    (set) => ({
      colorMap: 'turbo',
      fixedRange: undefined,
      showReasons: false,
      set: (change) => set(change),
    }),
    { name: 'visionserver.display' },
  ),
);
