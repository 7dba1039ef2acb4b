// @vitest-environment node
import { beforeEach, describe, expect, it } from 'vitest';
import { FramePairs } from './framePairs';

/** What two streams show, when items come in this order. */
class Screen {
  shown = { map: 0, picture: 0 };
  readonly steps: string[] = [];
  readonly passedOver: string[] = [];
  readonly kept: string[] = [];
  private drawNext: (() => void) | undefined;
  private patienceEnds: (() => void) | undefined;
  readonly pairs = new FramePairs((draw) => (this.drawNext = draw), {
    after: (_, call) => {
      this.patienceEnds = call;
      return () => (this.patienceEnds = undefined);
    },
  });

  arrive(view: 'map' | 'picture', number: number): void {
    const name = `${view} ${number}`;
    this.pairs[view].offer({
      frameNumber: BigInt(number),
      draw: () => (this.shown[view] = number),
      passOver: () => this.passedOver.push(name),
      keep: () => this.kept.push(name),
    });
  }

  /** An animation frame; notes what is on the screen, as "map picture". */
  frame(): void {
    const draw = this.drawNext;
    this.drawNext = undefined;
    draw?.();
    this.steps.push(`${this.shown.map} ${this.shown.picture}`);
  }

  maps(...numbers: number[]): this {
    for (const number of numbers) this.arrive('map', number);
    this.frame();
    return this;
  }

  pictures(...numbers: number[]): this {
    for (const number of numbers) this.arrive('picture', number);
    this.frame();
    return this;
  }

  wait(): void {
    this.patienceEnds?.();
    this.frame();
  }
}

let screen: Screen;
beforeEach(() => {
  screen = new Screen();
});

/** Map and picture 1 to 3, as pairs; each picture comes before the map of the frame before. */
function beginWithPairs() {
  screen.pictures(1).maps(1).pictures(2).pictures(3).maps(2).pictures(4).maps(3);
  screen.steps.length = 0;
}

describe('FramePairs', () => {
  it('shows the first of each stream at once', () => {
    screen.pictures(1).pictures(2).maps(1).maps(2);
    expect(screen.steps).toEqual(['0 1', '0 2', '1 2', '2 2']);
  });

  it('shows picture and map of one frame together, with each map, although pictures are ahead', () => {
    beginWithPairs();
    screen.pictures(5).maps(4).pictures(6).maps(5).pictures(7).maps(6);
    expect(screen.steps).toEqual(['3 3', '4 4', '4 4', '5 5', '5 5', '6 6']);
    expect(screen.passedOver).toEqual([]);
  });

  it('shows the newest pair when several came before the browser lets it draw', () => {
    beginWithPairs();
    screen.arrive('picture', 5);
    screen.arrive('map', 4);
    screen.arrive('map', 5);
    screen.pictures(6);
    expect(screen.steps).toEqual(['5 5']);
    expect(screen.passedOver).toEqual(['picture 4', 'map 4']);
  });

  it('lets a map whose picture was left out wait for the next one, and no longer', () => {
    beginWithPairs();
    screen.pictures(6).maps(4).maps(5).maps(6);
    // The waiting map 4 has its picture; 5 has none, 6 has.
    expect(screen.steps).toEqual(['3 3', '4 4', '4 4', '6 6']);
    screen.steps.length = 0;
    // Neither 7 nor 8 has one; the nearest is there.
    screen.pictures(9).maps(7).maps(8);
    expect(screen.steps).toEqual(['6 6', '6 6', '8 9']);
  });

  it('stays at the full rate when two streams never have the same frame', () => {
    beginWithPairs();
    for (let number = 6; number <= 20; number += 2) screen.pictures(number + 1).maps(number);
    const maps = screen.steps.map((step) => step.split(' ')[0]);
    expect(new Set(maps)).toEqual(new Set(['3', '8', '10', '12', '14', '16', '18', '20']));
    // A frame away at most, and pairs again as soon as there are some.
    for (const step of screen.steps.slice(4)) {
      const [map, picture] = step.split(' ').map(Number);
      expect(Math.abs(map! - picture!)).toBeLessThanOrEqual(1);
    }
    screen.pictures(22).pictures(23).maps(22);
    expect(screen.steps.at(-1)).toBe('22 22');
  });

  it('goes on with pictures when no maps come, and with pairs when they come again', () => {
    beginWithPairs();
    for (let number = 5; number <= 10; ++number) screen.pictures(number);
    // Picture 4 waits since before; five are the most that do.
    expect(screen.steps).toEqual(['3 3', '3 3', '3 3', '3 8', '3 9', '3 10']);
    screen.maps(10).pictures(11).maps(11);
    expect(screen.steps.slice(-3)).toEqual(['10 10', '10 10', '11 11']);
  });

  it('goes on with maps when no pictures come', () => {
    beginWithPairs();
    screen.maps(4).maps(5).maps(6).maps(7);
    expect(screen.steps).toEqual(['4 4', '4 4', '6 4', '7 4']);
  });

  it('shows the last picture of a sequence that stops before its map', () => {
    beginWithPairs();
    expect(screen.shown).toEqual({ map: 3, picture: 3 });
    screen.wait();
    expect(screen.shown).toEqual({ map: 3, picture: 4 });
  });

  it('shows the last map of a sequence that stops before its picture', () => {
    beginWithPairs();
    screen.maps(4).maps(5);
    expect(screen.shown.map).toBe(4);
    screen.wait();
    expect(screen.shown.map).toBe(5);
  });

  it('lets the streams go on while their items wait', () => {
    beginWithPairs();
    screen.kept.length = 0;
    screen.pictures(5);
    expect(screen.kept).toContain('picture 5');
    expect(screen.passedOver).toEqual([]);
  });

  it('begins anew when frames are counted from 1 again', () => {
    beginWithPairs();
    screen.pictures(1).pictures(2).maps(1).maps(2);
    expect(screen.steps.slice(-2)).toEqual(['1 1', '2 2']);
    expect(screen.passedOver).toEqual(['picture 4']);
  });

  it('passes over all that waits at the end, and draws nothing more', () => {
    beginWithPairs();
    screen.arrive('map', 4);
    screen.pairs.end();
    screen.frame();
    screen.wait();
    expect(screen.shown).toEqual({ map: 3, picture: 3 });
    expect(screen.passedOver.sort()).toEqual(['map 4', 'picture 4']);
  });
});
