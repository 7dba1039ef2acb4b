import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { listenToPointing } from './pointing';
import { type Pixel, Scene } from './scene';

// A canvas of 320 x 320 at (100, 50) of the window shows a picture of 640 x 480: at half its size,
// its upper left corner 40 below that of the canvas.
let scene: Scene;
let canvas: HTMLCanvasElement;
let chosen: Pixel[];
let end: () => void;

beforeEach(() => {
  scene = new Scene();
  scene.viewport.setPicture({ width: 640, height: 480 });
  scene.viewport.setCanvas({ width: 320, height: 320 });
  canvas = document.createElement('canvas');
  canvas.setPointerCapture = () => undefined;
  vi.spyOn(canvas, 'getBoundingClientRect').mockReturnValue(new DOMRect(100, 50, 320, 320));
  chosen = [];
  end = listenToPointing(canvas, scene, (pixel) => chosen.push(pixel));
});
afterEach(() => end());

/** (x, y) of the canvas. */
function pointer(type: string, x: number, y: number, pointerId = 1) {
  canvas.dispatchEvent(new PointerEvent(type, { clientX: 100 + x, clientY: 50 + y, pointerId }));
}

function wheel(deltaY: number, x: number, y: number, more: WheelEventInit = {}) {
  const at = { clientX: 100 + x, clientY: 50 + y };
  const event = new WheelEvent('wheel', { deltaY, ...at, cancelable: true, ...more });
  canvas.dispatchEvent(event);
  return event;
}

function key(name: string, more: KeyboardEventInit = {}) {
  const event = new KeyboardEvent('keydown', { key: name, cancelable: true, ...more });
  canvas.dispatchEvent(event);
  return event;
}

describe('The wheel', () => {
  it('zooms at the pointer, which stays on its pixel', () => {
    const before = scene.viewport.toPicture(80, 200);
    const event = wheel(-1000, 80, 200);
    // e to the power of 1.5.
    expect(scene.viewport.scale).toBeCloseTo(0.5 * 4.4817, 3);
    const after = scene.viewport.toPicture(80, 200);
    expect(after.x).toBeCloseTo(before.x, 9);
    expect(after.y).toBeCloseTo(before.y, 9);
    expect(event.defaultPrevented).toBe(true);
    wheel(1000, 80, 200);
    expect(scene.viewport.scale).toBe(0.5);
  });

  it('goes as far with lines as with pixels, and further with a pinch of the touch pad', () => {
    wheel(-3, 160, 160, { deltaMode: WheelEvent.DOM_DELTA_LINE });
    expect(scene.viewport.scale).toBeCloseTo(0.5 * Math.exp(99 * 0.0015), 9);
    scene.viewport.fit();
    wheel(-20, 160, 160, { ctrlKey: true });
    expect(scene.viewport.scale).toBeCloseTo(0.5 * Math.exp(100 * 0.0015), 9);
  });
});

describe('The pointer', () => {
  it('says which pixel it is on, and none beside the picture', () => {
    pointer('pointermove', 160, 160);
    expect(scene.cursor).toEqual({ x: 320, y: 240 });
    pointer('pointermove', 160, 39);
    expect(scene.cursor).toBeUndefined();
    pointer('pointermove', 0, 40);
    expect(scene.cursor).toEqual({ x: 0, y: 0 });
    pointer('pointerleave', 0, 0);
    expect(scene.cursor).toBeUndefined();
  });

  it('chooses the pixel of a click, also when the hand trembles', () => {
    pointer('pointerdown', 160, 160);
    pointer('pointermove', 162, 160);
    pointer('pointerup', 162, 160);
    expect(chosen).toEqual([{ x: 324, y: 240 }]);
  });

  it('drags the picture, and chooses nothing by it', () => {
    scene.viewport.zoom(4);
    const { left, top } = scene.viewport.origin();
    pointer('pointerdown', 160, 160);
    pointer('pointermove', 175, 150);
    pointer('pointermove', 190, 140);
    expect(scene.viewport.origin()).toEqual({ left: left + 30, top: top - 20, scale: 2 });
    pointer('pointerup', 190, 140);
    pointer('pointermove', 200, 100);
    expect(scene.viewport.origin()).toEqual({ left: left + 30, top: top - 20, scale: 2 });
    expect(chosen).toEqual([]);
  });

  it('zooms with two fingers, at their middle', () => {
    pointer('pointerdown', 140, 160, 1);
    pointer('pointerdown', 180, 160, 2);
    pointer('pointermove', 220, 160, 2);
    expect(scene.viewport.scale).toBe(1);
    pointer('pointerup', 140, 160, 1);
    pointer('pointerup', 220, 160, 2);
    expect(chosen).toEqual([]);
  });

  it('shows all of the picture again with a double click', () => {
    scene.viewport.zoom(4);
    canvas.dispatchEvent(new MouseEvent('dblclick'));
    expect(scene.viewport.scale).toBe(0.5);
  });
});

describe('Keys', () => {
  it('move the crosshair from the middle, by one or by ten, to the edge and no further', () => {
    key('ArrowRight');
    expect(scene.cursor).toEqual({ x: 321, y: 240 });
    key('ArrowDown', { shiftKey: true });
    expect(scene.cursor).toEqual({ x: 321, y: 250 });
    key('ArrowLeft', { shiftKey: true });
    key('ArrowUp');
    expect(scene.cursor).toEqual({ x: 311, y: 249 });
    for (let i = 0; i < 100; ++i) key('ArrowUp', { shiftKey: true });
    expect(scene.cursor).toEqual({ x: 311, y: 0 });
  });

  it('zoom at the crosshair and back', () => {
    scene.pin({ x: 500, y: 300 });
    const before = scene.viewport.toCanvas(500.5, 300.5);
    key('+');
    expect(scene.viewport.scale).toBe(0.75);
    expect(scene.viewport.toCanvas(500.5, 300.5).x).toBeCloseTo(before.x, 9);
    key('+');
    key('-');
    expect(scene.viewport.scale).toBeCloseTo(0.75, 9);
    key('0');
    expect(scene.viewport.scale).toBe(0.5);
  });

  it('keep the crosshair in view', () => {
    scene.viewport.zoom(8, 0, 40);
    for (let i = 0; i < 50; ++i) key('ArrowRight', { shiftKey: true });
    expect(scene.cursor!.x).toBe(639);
    const { x } = scene.viewport.toCanvas(639, 240);
    expect(x).toBeGreaterThan(0);
    expect(x).toBeLessThan(320);
  });

  it('choose with Enter and give up with Escape', () => {
    key('Enter');
    expect(chosen).toEqual([]);
    key('ArrowRight');
    key('Enter');
    expect(chosen).toEqual([{ x: 321, y: 240 }]);
    scene.mark({ x: 1, y: 1 });
    key('Escape');
    expect(scene.cursor).toBeUndefined();
    expect(scene.marks).toEqual([]);
  });

  it('of the browser stay its own', () => {
    expect(key('+', { ctrlKey: true }).defaultPrevented).toBe(false);
    expect(key('Tab').defaultPrevented).toBe(false);
    expect(scene.viewport.scale).toBe(0.5);
  });
});

it('nothing is listened to after the end', () => {
  end();
  wheel(-1000, 160, 160);
  key('+');
  expect(scene.viewport.scale).toBe(0.5);
});
