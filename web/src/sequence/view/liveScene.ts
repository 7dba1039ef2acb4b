import { Codec } from '../../gen/visionserver/v1/stream_pb';
import type { Frame } from '../codec/frame';
import { FramePairs } from '../stream/framePairs';
import { LiveStream } from '../stream/liveStream';
import type { Wanted } from '../stream/multiplexer';
import { browser, decoder, multiplexer } from '../stream/pageStreams';
import type { Figures } from '../stream/statistics';
import { useDisplay } from './display';
import { Scene } from './scene';

// To a browser on the server's own machine the line costs less than the packing.
const sameMachine = ['localhost', '127.0.0.1', '[::1]'].includes(location.hostname);

// A pointer that has left a view is often back soon.
const kReasonsKeptMs = 2000;

/** Streams of the two views; undefined shows nothing there. */
export interface Sources {
  map: string | undefined;
  picture: string | undefined;
}

export type View = keyof Sources;

/** A scene that is fed by the server. */
export class LiveScene extends Scene {
  private readonly live: Partial<Record<View, LiveStream<Frame>>> = {};
  private readonly notices: Partial<Record<View, string>> = {};

  /** Shows these streams until the answer is called. */
  watch(sources: Sources): () => void {
    const pairs = new FramePairs((draw) => browser.nextFrame(draw));
    let reasons = this.needsReasons();
    for (const view of ['map', 'picture'] as const) {
      const stream = sources[view];
      if (stream === undefined) continue;
      this.live[view] = this.open(view, wantedOf(view, stream, reasons), pairs);
    }
    const setReasons = (wanted: boolean) => {
      if (sources.map === undefined || reasons === wanted) return;
      reasons = wanted;
      this.live.map?.change(wantedOf('map', sources.map, reasons));
    };
    let notNeeded: ReturnType<typeof setTimeout> | undefined;
    const followNeed = () => {
      if (this.needsReasons()) {
        clearTimeout(notNeeded);
        notNeeded = undefined;
        setReasons(true);
      } else if (reasons) {
        notNeeded ??= setTimeout(() => {
          notNeeded = undefined;
          setReasons(false);
        }, kReasonsKeptMs);
      }
    };
    const endings = [
      useDisplay.subscribe((display) => {
        this.showAgain(display, browser.now_ms());
        followNeed();
      }),
      this.cursorChanged.on(followNeed),
      () => clearTimeout(notNeeded),
    ];
    return () => {
      for (const end of endings) end();
      for (const view of ['map', 'picture'] as const) {
        this.live[view]?.end();
        delete this.live[view];
        delete this.notices[view];
      }
      pairs.end();
      this.clear();
    };
  }

  /** Undefined while the view shows no stream. */
  figures(view: View): Figures | undefined {
    return this.live[view]?.figures();
  }

  /** Why nothing comes, in words; empty when something does. */
  notice(view: View): string {
    return this.notices[view] ?? '';
  }

  /** Why pixels are invalid is a plane of its own, to be sent and unpacked with each map. */
  private needsReasons(): boolean {
    return useDisplay.getState().showReasons || this.cursor !== undefined;
  }

  private open(view: View, wanted: Wanted, pairs: FramePairs): LiveStream<Frame> {
    return new LiveStream<Frame>(
      multiplexer,
      {
        wanted,
        decode: (item) => decoder.decode(item),
        draw: (frame) => this.show(frame, useDisplay.getState(), browser.now_ms()),
        track: pairs[view],
        release: (frame) => {
          if (frame.kind === 'picture') frame.bitmap.close();
        },
        onNotice: (text) => {
          this.notices[view] = text;
        },
      },
      browser,
    );
  }
}

const wantedOf = (view: View, stream: string, includeReasons: boolean): Wanted =>
  view === 'map'
    ? { stream, includeReasons }
    : { stream, codec: sameMachine ? Codec.RAW : Codec.UNSPECIFIED };
