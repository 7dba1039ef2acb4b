import { ColorTable } from './colorize';
import { useDisplay } from './display';
import { PixelCanvas } from './pixelCanvas';
import type { Scene } from './scene';

/** Keeps a canvas showing the scene's newest map or picture, without React. */
export class ImagePainter {
  private readonly pixels: PixelCanvas;
  private readonly colors = new ColorTable();
  private readonly endings: (() => void)[] = [];
  private asked = false;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly scene: Scene,
    what: 'map' | 'picture',
  ) {
    this.pixels = new PixelCanvas(canvas, scene.viewport);
    const show = what === 'map' ? () => this.showMap() : () => this.showPicture();
    const changed = what === 'map' ? scene.mapChanged : scene.pictureChanged;
    const paintSoon = () => this.paintSoon();
    this.endings.push(
      changed.on(show),
      scene.viewport.changed.on(paintSoon),
      scene.cursorChanged.on(paintSoon),
      scene.marksChanged.on(paintSoon),
    );
    if (what === 'picture') {
      scene.colorAt = (pixel) => this.pixels.colorAt(pixel);
      this.endings.push(() => {
        scene.colorAt = undefined;
      });
    }
    show();
  }

  end(): void {
    for (const end of this.endings) end();
  }

  resize(width: number, height: number): void {
    this.pixels.resize({ width, height });
    this.scene.viewport.setCanvas({ width, height });
    this.paint();
  }

  private showMap(): void {
    const { map, range } = this.scene;
    if (!map) return;
    const { colorMap, showReasons } = useDisplay.getState();
    const colors = this.colors.of(colorMap, range ?? { far: 0, near: 65535 });
    this.pixels.setMap(map, colors, showReasons ? map.reasons : undefined);
    this.canvas.dataset.frame = String(map.frameNumber);
    this.paint();
  }

  private showPicture(): void {
    const { picture } = this.scene;
    if (!picture) return;
    this.pixels.setPicture(picture.bitmap);
    this.canvas.dataset.frame = String(picture.frameNumber);
    this.paint();
  }

  /** Once for all that changes before the next animation frame. */
  private paintSoon(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.paint();
    });
  }

  private paint(): void {
    const { cursor, marks, viewport } = this.scene;
    this.pixels.paint({ cursor, ends: marks });
    const { left, top, scale } = viewport.origin();
    Object.assign(this.canvas.dataset, { left: String(left), top: String(top), scale: String(scale) });
  }
}
