import { type RefObject, useEffect } from 'react';
import type { Scene } from '../view/scene';
import type { CloudRenderer } from './cloudRenderer';

// A press that moves less than this is a click.
const kClickPx = 4;

/** While `measuring`, clicks and the Enter key mark points of the cloud that `host` shows. */
export function useCloudMeasuring(
  host: RefObject<HTMLElement | null>,
  renderer: RefObject<CloudRenderer | undefined>,
  scene: Scene,
  measuring: boolean,
): void {
  useEffect(() => {
    const element = host.current;
    if (!element || !measuring) return;
    const ended = new AbortController();
    const { signal } = ended;
    let pressed: PointerEvent | undefined;
    const mark = (x: number, y: number) => {
      const pixel = renderer.current?.pixelAt(x, y);
      if (pixel) scene.mark(pixel);
    };
    element.addEventListener('pointerdown', (event) => (pressed = event), { signal });
    element.addEventListener(
      'pointerup',
      (event) => {
        const moved =
          !pressed ||
          Math.hypot(event.clientX - pressed.clientX, event.clientY - pressed.clientY) > kClickPx;
        if (moved) return;
        const box = element.getBoundingClientRect();
        mark(event.clientX - box.left, event.clientY - box.top);
      },
      { signal },
    );
    // By keys: what is in the middle.
    element.addEventListener(
      'keydown',
      (event) => {
        if (event.key === 'Enter') mark(element.clientWidth / 2, element.clientHeight / 2);
      },
      { signal },
    );
    return () => ended.abort();
  }, [host, renderer, scene, measuring]);
}
