import { act, render, screen } from '@testing-library/react';
import { afterEach, beforeEach, expect, it, vi } from 'vitest';
import { setLanguage } from '../i18n';
import { StreamFigures } from './StreamFigures';
import { Statistics } from './stream/statistics';
import type { LiveScene } from './view/liveScene';

beforeEach(() => void vi.useFakeTimers());
afterEach(() => vi.useRealTimers());

it('a dash stands for the rate and the delay until they are known', async () => {
  await setLanguage('en');
  const statistics = new Statistics();
  let now_ms = 0;
  const scene = { figures: () => statistics.figures(now_ms) } as unknown as LiveScene;
  render(<StreamFigures scene={scene} />);
  const shown = () => {
    act(() => void vi.advanceTimersByTime(500));
    return ['fps', 'latency', 'dropped'].map((name) => screen.getByTestId(name).textContent);
  };
  expect(shown()).toEqual(['–', '–', '0']);
  statistics.onDrawn(0, 20);
  expect(shown()).toEqual(['–', '20 ms', '0']);
  now_ms = 500;
  statistics.onDrawn(now_ms, 20);
  expect(shown()).toEqual(['2.0 /s', '20 ms', '0']);
});
