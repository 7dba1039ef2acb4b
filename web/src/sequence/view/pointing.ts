import type { Pixel, Scene } from './scene';

const kWheelStep = 0.0015;
const kKeyZoom = 1.5;
// A press that moves less than this is a click.
const kClickPx = 4;

/**
 * Wheel, drag, pinch, click and keys on a canvas that shows the scene's viewport. `onChoose` is told
 * of a pixel that is clicked, or chosen by Enter.
 */
export function listenToPointing(
  canvas: HTMLCanvasElement,
  scene: Scene,
  onChoose: (pixel: Pixel) => void,
): () => void {
  const { viewport } = scene;
  const pressed = new Map<number, { x: number; y: number }>();
  let travelled_px = 0;

  const place = (event: MouseEvent) => {
    const box = canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  const pixelAt = (at: { x: number; y: number }): Pixel | undefined => {
    const { x, y } = viewport.toPicture(at.x, at.y);
    const { width, height } = viewport.pictureSize;
    if (x < 0 || y < 0 || x >= width || y >= height) return undefined;
    return { x: Math.floor(x), y: Math.floor(y) };
  };

  const onWheel = (event: WheelEvent) => {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 33 : 1;
    // A pinch on a touch pad comes as a wheel with the control key, in small steps.
    const factor = event.ctrlKey ? 5 : 1;
    const { x, y } = place(event);
    viewport.zoom(Math.exp(-event.deltaY * lines * factor * kWheelStep), x, y);
  };
  const onDown = (event: PointerEvent) => {
    canvas.setPointerCapture(event.pointerId);
    pressed.set(event.pointerId, place(event));
    travelled_px = pressed.size > 1 ? Infinity : 0;
  };
  const onMove = (event: PointerEvent) => {
    const at = place(event);
    const before = pressed.get(event.pointerId);
    if (!before) {
      scene.hover(pixelAt(at));
      return;
    }
    pressed.set(event.pointerId, at);
    const [dx, dy] = [at.x - before.x, at.y - before.y];
    travelled_px += Math.hypot(dx, dy);
    const other = [...pressed].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const apart = (point: { x: number; y: number }) =>
        Math.max(Math.hypot(point.x - other.x, point.y - other.y), 1);
      viewport.zoom(apart(at) / apart(before), (at.x + other.x) / 2, (at.y + other.y) / 2);
      viewport.pan(dx / 2, dy / 2);
    } else if (travelled_px >= kClickPx) {
      viewport.pan(dx, dy);
    }
  };
  const onUp = (event: PointerEvent) => {
    const at = pressed.get(event.pointerId);
    pressed.delete(event.pointerId);
    const pixel = at && pixelAt(at);
    if (pixel && travelled_px < kClickPx && event.type === 'pointerup') onChoose(pixel);
  };
  const onLeave = () => scene.hover(undefined);
  const onDoubleClick = () => viewport.fit();

  const moveCrosshair = (dx: number, dy: number) => {
    const { width, height } = viewport.pictureSize;
    const from = scene.cursor ?? { x: Math.floor(width / 2), y: Math.floor(height / 2) };
    const within = (value: number, size: number) => Math.min(Math.max(value, 0), size - 1);
    const to = { x: within(from.x + dx, width), y: within(from.y + dy, height) };
    scene.pin(to);
    viewport.reveal(to.x, to.y);
  };
  const onKey = (event: KeyboardEvent) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = event.shiftKey ? 10 : 1;
    const keys: Record<string, () => void> = {
      ArrowLeft: () => moveCrosshair(-step, 0),
      ArrowRight: () => moveCrosshair(step, 0),
      ArrowUp: () => moveCrosshair(0, -step),
      ArrowDown: () => moveCrosshair(0, step),
      '+': () => zoomAtCrosshair(kKeyZoom),
      '=': () => zoomAtCrosshair(kKeyZoom),
      '-': () => zoomAtCrosshair(1 / kKeyZoom),
      '0': () => viewport.fit(),
      Enter: () => scene.cursor && onChoose(scene.cursor),
      Escape: () => {
        scene.clearMarks();
        scene.pin(undefined);
      },
    };
    const act = keys[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  };
  const zoomAtCrosshair = (factor: number) => {
    const { cursor } = scene;
    const at = cursor && viewport.toCanvas(cursor.x + 0.5, cursor.y + 0.5);
    viewport.zoom(factor, at?.x, at?.y);
  };

  const ended = new AbortController();
  const { signal } = ended;
  canvas.addEventListener('wheel', onWheel, { passive: false, signal });
  canvas.addEventListener('pointerdown', onDown, { signal });
  canvas.addEventListener('pointermove', onMove, { signal });
  canvas.addEventListener('pointerup', onUp, { signal });
  canvas.addEventListener('pointercancel', onUp, { signal });
  canvas.addEventListener('pointerleave', onLeave, { signal });
  canvas.addEventListener('dblclick', onDoubleClick, { signal });
  canvas.addEventListener('keydown', onKey, { signal });
  return () => ended.abort();
}
