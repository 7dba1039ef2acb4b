import {
  DataTexture,
  GLSL3,
  LinearFilter,
  RawShaderMaterial,
  RedIntegerFormat,
  RGBAFormat,
  Texture,
  UnsignedByteType,
  UnsignedShortType,
  Vector2,
} from 'three';
import type { MapFrame, PictureFrame } from '../codec/frame';
import { type ColorMap, palette } from '../view/colorMap';
import type { StoredRange } from '../view/colorize';
import { fragmentShader, vertexShader } from './shader';

// Height is -y of the camera's frame: up in the picture, however the camera hangs.
export const colorings = ['depth', 'height', 'picture'] as const;
export type Coloring = (typeof colorings)[number];

/** What the shaders draw: the newest map as a texture, and how it is coloured. */
export class CloudMaterial extends RawShaderMaterial {
  private mapTexture = mapTextureOf(new Uint16Array(1), 1, 1);
  private readonly paletteTexture = new DataTexture(
    new Uint8Array(4 * 256),
    256,
    1,
    RGBAFormat,
    UnsignedByteType,
  );
  private readonly pictureTexture = new Texture();
  private colorMap: ColorMap | undefined;

  constructor() {
    super({ glslVersion: GLSL3, vertexShader, fragmentShader });
    this.pictureTexture.minFilter = LinearFilter;
    this.pictureTexture.generateMipmaps = false;
    this.pictureTexture.flipY = false;
    const values: Record<string, unknown> = {
      map: this.mapTexture,
      palette: this.paletteTexture,
      picture: this.pictureTexture,
      isDepth: 0,
      scale: 1,
      offset: 0,
      focal: 1,
      baseline: 1,
      principalOffset: 0,
      center: new Vector2(),
      nearFar: new Vector2(1, 0),
      lowHigh: new Vector2(1, 0),
      coloring: 0,
      step: 1,
      pointSize: 2,
    };
    this.uniforms = Object.fromEntries(
      Object.entries(values).map(([name, value]) => [name, { value }]),
    );
  }

  set(name: string, value: number): void {
    this.uniforms[name]!.value = value;
  }

  setMap(map: MapFrame, range: StoredRange | undefined): void {
    const { width, height } = this.mapTexture.image;
    if (width !== map.width || height !== map.height) {
      this.mapTexture.dispose();
      this.mapTexture = mapTextureOf(map.stored, map.width, map.height);
      this.uniforms['map']!.value = this.mapTexture;
    }
    this.mapTexture.image.data = map.stored;
    this.mapTexture.needsUpdate = true;
    const { geometry } = map;
    this.set('isDepth', map.kind === 'depth' ? 1 : 0);
    this.set('scale', map.scale);
    this.set('offset', map.offset);
    this.set('focal', geometry.focalPx);
    this.set('baseline', geometry.baselineM);
    this.set('principalOffset', geometry.principalOffsetPx);
    (this.uniforms['center']!.value as Vector2).set(geometry.cxPx, geometry.cyPx);
    if (range) (this.uniforms['nearFar']!.value as Vector2).set(range.near, range.far);
  }

  setPicture({ bitmap }: PictureFrame): void {
    const known = this.pictureTexture.image as ImageBitmap | undefined;
    if (known?.width !== bitmap.width || known.height !== bitmap.height) {
      this.pictureTexture.dispose();
    }
    this.pictureTexture.image = bitmap;
    this.pictureTexture.needsUpdate = true;
  }

  /** y in metres that are the first and the last colour. */
  setHeights(low_m: number, high_m: number): void {
    (this.uniforms['lowHigh']!.value as Vector2).set(low_m, high_m);
  }

  setColorMap(colorMap: ColorMap): void {
    if (colorMap === this.colorMap) return;
    this.colorMap = colorMap;
    this.paletteTexture.image.data = new Uint8Array(palette(colorMap).buffer);
    this.paletteTexture.needsUpdate = true;
  }

  disposeAll(): void {
    this.mapTexture.dispose();
    this.paletteTexture.dispose();
    this.pictureTexture.dispose();
    this.dispose();
  }
}

function mapTextureOf(stored: Uint16Array, width: number, height: number): DataTexture {
  const texture = new DataTexture(stored, width, height, RedIntegerFormat, UnsignedShortType);
  texture.internalFormat = 'R16UI';
  texture.unpackAlignment = 2;
  texture.needsUpdate = true;
  return texture;
}
