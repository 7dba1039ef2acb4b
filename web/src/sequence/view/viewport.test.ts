// @vitest-environment node
import { describe, expect, it } from 'vitest';
import { roundest, ticks } from './ticks';
import { type Size, Viewport } from './viewport';

function viewport() {
  const view = new Viewport();
  view.setPicture({ width: 640, height: 480 });
  view.setCanvas({ width: 320, height: 320 });
  return view;
}

describe('Viewport', () => {
  it('shows all of the picture, in the middle, at first', () => {
    const view = viewport();
    expect(view.origin()).toEqual({ left: 0, top: 40, scale: 0.5 });
    view.setCanvas({ width: 640, height: 480 });
    expect(view.origin()).toEqual({ left: 0, top: 0, scale: 1 });
  });

  it('keeps what is under the pointer where it is while zooming', () => {
    const view = viewport();
    const before = view.toPicture(100, 200);
    view.zoom(4, 100, 200);
    expect(view.scale).toBe(2);
    expect(view.toPicture(100, 200).x).toBeCloseTo(before.x, 9);
    expect(view.toPicture(100, 200).y).toBeCloseTo(before.y, 9);
  });

  it('moves with the hand, but not beyond the edge', () => {
    const view = viewport();
    view.zoom(4);
    const { left, top } = view.origin();
    view.pan(30, -20);
    expect(view.origin()).toEqual({ left: left + 30, top: top - 20, scale: 2 });
    view.pan(10_000, 10_000);
    expect(view.origin()).toEqual({ left: 0, top: 0, scale: 2 });
    view.pan(-10_000, -10_000);
    expect(view.origin()).toEqual({ left: 320 - 1280, top: 320 - 960, scale: 2 });
  });

  it('does not move while all is seen, and does not become smaller than that', () => {
    const view = viewport();
    view.pan(50, 50);
    expect(view.origin()).toEqual({ left: 0, top: 40, scale: 0.5 });
    view.zoom(3);
    view.zoom(0.01);
    expect(view.scale).toBe(0.5);
  });

  it('ends at 64 screen pixels for one', () => {
    const view = viewport();
    for (let i = 0; i < 20; ++i) view.zoom(2);
    expect(view.scale).toBe(64);
  });

  it('follows a crosshair that leaves the canvas', () => {
    const view = viewport();
    view.zoom(8);
    view.reveal(10, 10);
    const { x, y } = view.toCanvas(10.5, 10.5);
    expect(x).toBeGreaterThanOrEqual(0);
    expect(y).toBeGreaterThanOrEqual(0);
    expect(x).toBeLessThan(320);
    expect(y).toBeLessThan(320);
  });

  it('keeps the size of a picture and not the picture', () => {
    const view = new Viewport();
    view.setPicture({ width: 2, height: 3, stored: new Uint16Array(6) } as Size);
    expect(view.pictureSize).toEqual({ width: 2, height: 3 });
  });

  it('begins anew with a picture of another size', () => {
    const view = viewport();
    view.zoom(8);
    view.setPicture({ width: 640, height: 480 });
    expect(view.scale).toBe(4);
    view.setPicture({ width: 320, height: 240 });
    expect(view.scale).toBe(1);
  });
});

describe('ticks', () => {
  it('are the roundest numbers there are', () => {
    expect(roundest(0.83, 0.88)).toBe(0.85);
    expect(roundest(0.9, 1.2)).toBe(1);
    expect(roundest(1.91, 2.4)).toBe(2);
    expect(roundest(12, 48)).toBe(20);
    expect(roundest(0.8521, 0.8529)).toBe(0.8525);
  });

  it('lie where their values are, on a scale of disparities', () => {
    // 60 px m: from 2 m (30 px) to 0.5 m (120 px).
    const valueAt = (place: number) => 60 / (30 + 90 * place);
    const placeOf = (value: number) => (60 / value - 30) / 90;
    const found = ticks(valueAt, placeOf, 4);
    expect(found.map(({ value }) => value)).toEqual([1.5, 1, 0.7, 0.55]);
    for (const { value, place } of found) expect(valueAt(place)).toBeCloseTo(value, 9);
  });
});
