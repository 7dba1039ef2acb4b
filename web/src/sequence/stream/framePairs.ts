import { browserTimers, type Timers } from './multiplexer';

/** A decoded item that waits for the screen. Each is drawn or passed over, once. */
export interface Waiting {
  /** Of the exposure: what several streams have of one exposure has one number. */
  readonly frameNumber: bigint;
  draw(): void;
  passOver(): void;
  /** It waits longer than until the next animation frame; its stream goes on meanwhile. */
  keep(): void;
}

// Pictures that wait for their map: as many as a sequence has under way, and some.
const kKept = 5;
// What has waited so long for its partner is shown without it.
const kPatienceMs = 500;

/** What waits of one stream, oldest first. */
export class Track {
  waiting: Waiting[] = [];
  /** Frame number of what is on the screen. */
  shown: bigint | undefined;

  /** Keeps the newest `kept`; `changed` is told when there is a new one. */
  constructor(
    private readonly kept: number,
    private readonly changed: () => void,
  ) {}

  /** Undefined before the first item. */
  get newest(): bigint | undefined {
    return this.waiting.at(-1)?.frameNumber ?? this.shown;
  }

  offer(item: Waiting): void {
    // Frames are counted anew when the sequence was started again.
    if (this.newest !== undefined && item.frameNumber < this.newest) this.clear();
    if (this.kept > 1) this.waiting.at(-1)?.keep();
    this.waiting.push(item);
    if (this.waiting.length > this.kept) this.waiting.shift()!.passOver();
    this.changed();
  }

  /** It is on the screen, or could be. */
  has(frameNumber: bigint): boolean {
    return this.shown === frameNumber || this.waiting.some((one) => one.frameNumber === frameNumber);
  }

  /** Draws the newest that is not newer than this, and passes over what is older. */
  showUpTo(frameNumber: bigint): void {
    const later = this.waiting.findIndex((one) => one.frameNumber > frameNumber);
    const due = this.waiting.splice(0, later < 0 ? this.waiting.length : later);
    const last = due.pop();
    for (const item of due) item.passOver();
    if (!last) return;
    this.shown = last.frameNumber;
    last.draw();
  }

  clear(): void {
    for (const item of this.waiting.splice(0)) item.passOver();
    this.shown = undefined;
  }
}

/**
 * Shows map and picture of the same exposure together, though they come one after the other: in each
 * animation frame the newest exposure that both have. The picture, which is there first, follows the
 * map. A map waits for its picture until the next map at most, so that the screen stays fresh
 * when a stream leaves frames out; what finds no partner is shown with the nearest there is.
 */
export class FramePairs {
  readonly map = new Track(kKept, () => {
    this.mapsCome = true;
    this.drawSoon();
  });
  readonly picture = new Track(kKept, () => this.drawSoon());
  /** What was drawn last was a pair, so that the next may be one. */
  private paired = false;
  /** There is a map to wait for. */
  private mapsCome = false;
  private asked = false;
  private cancelPatience: (() => void) | undefined;

  constructor(
    private readonly nextFrame: (draw: () => void) => void,
    private readonly timers: Timers = browserTimers,
  ) {}

  /** Passes over all that waits. */
  end(): void {
    this.endPatience();
    this.map.clear();
    this.picture.clear();
  }

  private drawSoon(): void {
    if (this.asked) return;
    this.asked = true;
    this.nextFrame(() => {
      this.asked = false;
      this.draw(false);
    });
  }

  private draw(impatient: boolean): void {
    const { map, picture } = this;
    const before = [map.shown, picture.shown];
    this.choose(impatient);
    const waiting = [...map.waiting, ...picture.waiting];
    for (const item of waiting) item.keep();
    if (impatient || map.shown !== before[0] || picture.shown !== before[1]) this.endPatience();
    if (waiting.length > 0) {
      this.cancelPatience ??= this.timers.after(kPatienceMs, () => this.draw(true));
    }
  }

  private endPatience(): void {
    this.cancelPatience?.();
    this.cancelPatience = undefined;
  }

  private choose(impatient: boolean): void {
    const { map, picture } = this;
    const pair = this.newestPair();
    if (pair !== undefined) {
      // First the picture: the cloud is drawn with each map, in the picture's colours.
      picture.showUpTo(pair);
      map.showUpTo(pair);
      this.paired = true;
    } else if (map.waiting.length > 0) {
      if (impatient || !this.mapMayWait()) this.showMapAlone();
    } else if (picture.waiting.length > 0) {
      if (picture.waiting.length === kKept) this.mapsCome = false;
      if (!this.mapsCome) picture.showUpTo(picture.newest!);
      else if (impatient) picture.showUpTo(picture.waiting[0]!.frameNumber);
    }
  }

  /** The newest frame that both have and of which something is not yet on the screen. */
  private newestPair(): bigint | undefined {
    const { map, picture } = this;
    return [...map.waiting, ...picture.waiting]
      .map((one) => one.frameNumber)
      .filter((number) => map.has(number) && picture.has(number))
      .sort((a, b) => Number(b - a))[0];
  }

  private mapMayWait(): boolean {
    const { map, picture, paired } = this;
    if (!paired || map.waiting.length > 1) return false;
    // Either its own picture may yet come, or the next map's is already there.
    return picture.newest! < map.newest! || picture.waiting.length > 0;
  }

  private showMapAlone(): void {
    const { map, picture } = this;
    const number = map.newest!;
    const nearest = [picture.shown, ...picture.waiting.map((one) => one.frameNumber)]
      .filter((one) => one !== undefined)
      .sort((a, b) => Number(distance(a, number) - distance(b, number)))[0];
    if (nearest !== undefined) picture.showUpTo(nearest);
    map.showUpTo(number);
    this.paired = false;
  }
}

const distance = (a: bigint, b: bigint) => (a > b ? a - b : b - a);
