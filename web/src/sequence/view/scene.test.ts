// @vitest-environment node
import { expect, it } from 'vitest';
import type { PictureFrame } from '../codec/frame';
import { Scene } from './scene';

it('A scene closes a picture after all views have gone over to the next', () => {
  const closed: string[] = [];
  const pictureOf = (name: string) =>
    ({ kind: 'picture', width: 1, height: 1, bitmap: { close: () => closed.push(name) } }) as unknown as PictureFrame;
  const display = { colorMap: 'turbo', fixedRange: undefined, showReasons: false } as const;
  const scene = new Scene();
  scene.show(pictureOf('first'), display, 0);
  const atChange: string[][] = [];
  scene.pictureChanged.on(() => atChange.push([...closed]));
  scene.show(pictureOf('second'), display, 33);
  expect(atChange).toEqual([[]]);
  expect(closed).toEqual(['first']);
});
