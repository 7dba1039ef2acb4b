import '../../i18n';
import { create } from '@bufbuild/protobuf';
import { MantineProvider } from '@mantine/core';
import { act, render, screen } from '@testing-library/react';
import { beforeEach, describe, expect, it } from 'vitest';
import { RectifiedGeometrySchema } from '../../gen/visionserver/v1/stream_pb';
import { setLanguage } from '../../i18n';
import type { MapFrame } from '../codec/frame';
import { Inspector } from './Inspector';
import { Scene } from './scene';

// 60 px m: 60 px is 1 m. The second pixel lies outside of the right picture.
const mapOf = (stored: number): MapFrame => ({
  kind: 'disparity',
  width: 2,
  height: 1,
  step: 1,
  frameNumber: 1n,
  captureTime: new Date(0),
  stored: Uint16Array.of(stored, 0),
  reasons: Uint8Array.of(0, 8),
  scale: 1 / 16,
  offset: 0,
  geometry: create(RectifiedGeometrySchema, { focalPx: 500, baselineM: 0.12, cxPx: 5, cyPx: 0 }),
});
const display = { colorMap: 'turbo', fixedRange: undefined, showReasons: false } as const;
const field = (name: string) => screen.getByTestId(`inspector-${name}`).textContent;

describe('Inspector', () => {
  let scene: Scene;
  beforeEach(async () => {
    await setLanguage('en');
    scene = new Scene();
    scene.show(mapOf(960), display, 0);
    render(
      <MantineProvider env="test">
        <Inspector scene={scene} />
      </MantineProvider>,
    );
  });

  it('reads the pixel under the pointer, and again with each frame', () => {
    expect(field('depth')).toBe('–');
    scene.hover({ x: 0, y: 0 });
    expect([field('x'), field('y')]).toEqual(['0 px', '0 px']);
    expect(field('disparity')).toBe('60.00 px');
    expect(field('depth')).toBe('1.0000 m');
    expect(field('X')).toBe('-0.0100 m');
    scene.show(mapOf(480), display, 33);
    expect(field('depth')).toBe('2.0000 m');
  });

  it('says in words why a pixel is invalid, in the language of the page', async () => {
    scene.hover({ x: 1, y: 0 });
    expect([field('depth'), field('reason')]).toEqual(['–', 'outside the right picture']);
    await act(() => setLanguage('de'));
    expect(field('reason')).toBe('außerhalb des rechten Bildes');
  });

  it('goes back to the chosen pixel when the pointer leaves', () => {
    scene.pin({ x: 0, y: 0 });
    scene.hover({ x: 1, y: 0 });
    expect(field('x')).toBe('1 px');
    scene.hover(undefined);
    expect(field('x')).toBe('0 px');
  });

  it('speaks of a chosen pixel', async () => {
    scene.pin({ x: 0, y: 0 });
    expect(await screen.findByText('x 0 px, y 0 px: 1.0000 m')).toBeTruthy();
  });
});
