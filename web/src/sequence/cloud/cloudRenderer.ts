import {
  AxesHelper,
  BufferGeometry,
  Float32BufferAttribute,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  PerspectiveCamera,
  Points,
  PointsMaterial,
  Scene as World,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { MapFrame } from '../codec/frame';
import { useDisplay } from '../view/display';
import { depth_m, pointOf } from '../view/geometry';
import type { Pixel, Scene } from '../view/scene';
import { CloudMaterial, type Coloring, colorings } from './cloudMaterial';
import { pick } from './pick';

export interface CloudOptions {
  coloring: Coloring;
  pointSize_px: number;
  axes: boolean;
  /** Every how many pixels, both ways. */
  step: number;
}

const kAxesM = 0.1;
const kHeightsPeriodMs = 500;
const kZoomStep = 1.25;

/**
 * Draws the scene's newest map as points in space, on a canvas of its own in `host`: a canvas never
 * gets another WebGL context than its first, and a page has a few of them only. Needs WebGL 2.
 */
export class CloudRenderer {
  private readonly canvas = document.createElement('canvas');
  private readonly renderer: WebGLRenderer;
  private readonly world = new World();
  private readonly camera = new PerspectiveCamera(45, 1, 0.01, 1000);
  private readonly controls: OrbitControls;
  private readonly material = new CloudMaterial();
  private readonly points = new Points(new BufferGeometry(), this.material);
  private readonly axes = new AxesHelper(kAxesM);
  private readonly ends = new Points(
    new BufferGeometry(),
    new PointsMaterial({ size: 9, sizeAttenuation: false, depthTest: false, color: '#ff4fd8' }),
  );
  private readonly line = new LineSegments(
    new BufferGeometry(),
    new LineBasicMaterial({ depthTest: false, color: '#ff4fd8' }),
  );
  private readonly endings: (() => void)[];
  /** Of the two marks, for both that draw them. */
  private readonly places = new Float32BufferAttribute(new Float32Array(6), 3);
  private ended = false;
  private step = 1;
  private placed = false;
  private asked = false;
  private heightsAt_ms = -Infinity;

  constructor(
    private readonly host: HTMLElement,
    private readonly scene: Scene,
  ) {
    this.renderer = new WebGLRenderer({ canvas: this.canvas, antialias: false });
    host.append(this.canvas);
    this.renderer.setClearColor('#101113');
    this.camera.up.set(0, -1, 0); // y of the left view points down
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener('change', () => this.renderSoon());
    this.controls.listenToKeyEvents(host);
    for (const object of [this.points, this.ends, this.line]) object.frustumCulled = false;
    this.ends.renderOrder = this.line.renderOrder = 1;
    this.world.add(this.points, this.axes, this.ends, this.line);
    for (const { geometry } of [this.ends, this.line]) {
      geometry.setAttribute('position', this.places);
      geometry.setDrawRange(0, 0);
    }
    this.endings = [
      scene.mapChanged.on(() => this.showMap()),
      scene.pictureChanged.on(() => this.showPicture()),
      scene.marksChanged.on(() => this.showMarks()),
    ];
    this.showPicture();
    this.showMap();
  }

  end(): void {
    this.ended = true;
    for (const end of this.endings) end();
    this.controls.dispose();
    this.material.disposeAll();
    this.axes.dispose();
    for (const { geometry, material } of [this.ends, this.line]) {
      geometry.dispose();
      material.dispose();
    }
    this.points.geometry.dispose();
    this.renderer.dispose();
    // Not when the canvas happens to be collected: the browser would take a context that is in use.
    this.renderer.forceContextLoss();
    this.canvas.remove();
    delete this.host.dataset.frame;
  }

  setOptions({ coloring, pointSize_px, axes, step }: CloudOptions): void {
    this.material.set('coloring', colorings.indexOf(coloring));
    this.material.set('pointSize', pointSize_px * window.devicePixelRatio);
    this.material.set('step', step);
    this.step = step;
    this.axes.visible = axes;
    this.showMap();
  }

  resize(width: number, height: number): void {
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(height, 1);
    this.camera.updateProjectionMatrix();
    this.render();
  }

  /** Looks at the middle of the cloud, from above and a little from the side. */
  reset(): void {
    const { map, range } = this.scene;
    if (!map || !range) return;
    const z_m = (depth_m(map, range.near) + depth_m(map, range.far)) / 2;
    this.controls.target.set(0, 0, z_m);
    this.camera.position.set(0.45 * z_m, -0.5 * z_m, -0.25 * z_m);
    this.controls.update();
    this.placed = true;
    this.renderSoon();
  }

  zoom(closer: boolean): void {
    if (closer) this.controls.dollyIn(kZoomStep);
    else this.controls.dollyOut(kZoomStep);
    this.controls.update();
  }

  /** The pixel whose point is seen at (x, y) of the canvas; undefined where there is none. */
  pixelAt(x: number, y: number): Pixel | undefined {
    const { map } = this.scene;
    if (!map) return undefined;
    this.camera.updateMatrixWorld();
    const clip = new Matrix4().multiplyMatrices(
      this.camera.projectionMatrix,
      this.camera.matrixWorldInverse,
    );
    const size = { width: this.canvas.clientWidth, height: this.canvas.clientHeight };
    return pick(map, clip.elements, { x, y }, size, this.step);
  }

  private showMap(): void {
    const { map, range } = this.scene;
    if (!map) return;
    this.material.setColorMap(useDisplay.getState().colorMap);
    this.material.setMap(map, range);
    this.followHeights(map);
    const count = Math.ceil(map.width / this.step) * Math.ceil(map.height / this.step);
    this.points.geometry.setDrawRange(0, count);
    if (!this.placed) this.reset();
    this.placeMarks(map);
    this.render();
    this.host.dataset.frame = String(map.frameNumber);
  }

  private showPicture(): void {
    const { picture } = this.scene;
    if (picture) this.material.setPicture(picture);
  }

  private showMarks(): void {
    if (this.scene.map) this.placeMarks(this.scene.map);
    this.renderSoon();
  }

  private placeMarks(map: MapFrame): void {
    const points = this.scene.marks
      .map(({ x, y }) => pointOf(map, x, y))
      .filter((point) => point !== undefined);
    points.forEach(({ x_m, y_m, z_m }, i) => this.places.setXYZ(i, x_m, y_m, z_m));
    if (points.length > 0) this.places.needsUpdate = true;
    this.ends.geometry.setDrawRange(0, points.length);
    this.line.geometry.setDrawRange(0, points.length === 2 ? 2 : 0);
  }

  /** Colours by height run over the heights that there are, but for 2 % at either end. */
  private followHeights(map: MapFrame): void {
    const now_ms = performance.now();
    if (now_ms - this.heightsAt_ms < kHeightsPeriodMs) return;
    this.heightsAt_ms = now_ms;
    const heights: number[] = [];
    for (let y = 0; y < map.height; y += 11) {
      for (let x = 0; x < map.width; x += 7) {
        const point = pointOf(map, x, y);
        if (point) heights.push(point.y_m);
      }
    }
    if (heights.length === 0) return;
    heights.sort((a, b) => a - b);
    const at = (share: number) => heights[Math.floor((heights.length - 1) * share)]!;
    // y points down: the lowest place has the largest.
    this.material.setHeights(at(0.98), at(0.02));
  }

  /** Once for all that changes before the next animation frame. */
  private renderSoon(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.render();
    });
  }

  private render(): void {
    if (this.ended) return;
    this.renderer.render(this.world, this.camera);
  }
}
