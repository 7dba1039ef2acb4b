import type * as Three from 'three';
import { beforeEach, expect, it, vi } from 'vitest';
import { LiveScene } from '../view/liveScene';
import { CloudRenderer } from './cloudRenderer';

// What a browser gives to a page at most; the oldest would be taken away for one more.
const kMostContexts = 16;

const contexts = vi.hoisted(() => ({ live: new Set<unknown>(), lost: new Set<unknown>() }));

vi.mock('three', async (original) => ({
  ...(await original<typeof Three>()),
  WebGLRenderer: class {
    private readonly canvas;

    constructor({ canvas }: Three.WebGLRendererParameters) {
      if (contexts.lost.has(canvas)) throw new Error('this canvas has lost its context');
      contexts.live.add(canvas);
      this.canvas = canvas;
    }

    setClearColor() {}
    render() {}
    dispose() {}

    forceContextLoss() {
      contexts.live.delete(this.canvas);
      contexts.lost.add(this.canvas);
    }
  },
}));

beforeEach(() => {
  contexts.live.clear();
  contexts.lost.clear();
});

it('the cloud can be opened and left 30 times in the same place', () => {
  const host = document.createElement('div');
  const scene = new LiveScene();
  for (let i = 0; i < 30; ++i) {
    const renderer = new CloudRenderer(host, scene);
    expect(contexts.live.size).toBeLessThanOrEqual(kMostContexts);
    expect(host.querySelectorAll('canvas')).toHaveLength(1);
    renderer.end();
    expect(contexts.live.size).toBe(0);
    expect(host.querySelectorAll('canvas')).toHaveLength(0);
  }
});
