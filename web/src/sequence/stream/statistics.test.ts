// @vitest-environment node
import { describe, expect, it } from 'vitest';
import { Statistics } from './statistics';

describe('Statistics', () => {
  it('knows nothing before the first picture', () => {
    const figures = new Statistics().figures(5000);
    expect(figures).toEqual({
      fps: undefined,
      latency_ms: undefined,
      dropped: 0,
      age_ms: undefined,
      stale: false,
    });
  });

  it('counts what was drawn in the last two seconds', () => {
    const statistics = new Statistics();
    for (let time_ms = 0; time_ms <= 10_000; time_ms += 40) statistics.onDrawn(time_ms, 50);
    expect(statistics.figures(10_000).fps).toBe(25);
    // Half of the window later without a picture.
    expect(statistics.figures(11_000).fps).toBe(12.5);
    expect(statistics.figures(13_000).fps).toBe(0);
  });

  it('knows no rate by one picture, and that there is none when no other follows', () => {
    const statistics = new Statistics();
    statistics.onDrawn(1000, 50);
    expect(statistics.figures(1000).fps).toBeUndefined();
    expect(statistics.figures(2900).fps).toBeUndefined();
    expect(statistics.figures(3000).fps).toBe(0);
  });

  it('shows a rate soon after the beginning', () => {
    const statistics = new Statistics();
    for (let i = 0; i <= 5; ++i) statistics.onDrawn(i * 100, 50);
    expect(statistics.figures(500).fps).toBe(10);
  });

  it('shows the middle latency', () => {
    const statistics = new Statistics();
    [30, 500, 40, 50, 35].forEach((latency_ms, i) => statistics.onDrawn(i, latency_ms));
    statistics.onDrawn(5, undefined);
    expect(statistics.figures(6).latency_ms).toBe(40);
  });

  it('is stale a second after the last picture', () => {
    const statistics = new Statistics();
    statistics.onDrawn(100, 20);
    expect(statistics.figures(1100)).toMatchObject({ age_ms: 1000, stale: false });
    expect(statistics.figures(1101)).toMatchObject({ age_ms: 1001, stale: true });
    statistics.onDrawn(1200, 20);
    expect(statistics.figures(1201).stale).toBe(false);
  });

  it('counts what was not drawn', () => {
    const statistics = new Statistics();
    statistics.onDropped(3);
    statistics.onDropped(1);
    expect(statistics.figures(0).dropped).toBe(4);
  });
});
