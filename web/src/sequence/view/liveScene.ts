import { Codec } from '../../gen/visionserver/v1/stream_pb';
import type { Frame } from '../codec/frame';
import { LiveStream } from '../stream/liveStream';
import { browser, decoder, multiplexer } from '../stream/pageStreams';
import type { Figures } from '../stream/statistics';
import { useDisplay } from './display';
import { Scene } from './scene';

// To a browser on the server's own machine the line costs less than the packing.
const sameMachine = ['localhost', '127.0.0.1', '[::1]'].includes(location.hostname);

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
    const endColors = useDisplay.subscribe((display) => this.showAgain(display, browser.now_ms()));
    for (const view of ['map', 'picture'] as const) {
      const stream = sources[view];
      if (stream !== undefined) this.live[view] = this.open(view, stream);
    }
    return () => {
      endColors();
      for (const view of ['map', 'picture'] as const) {
        this.live[view]?.end();
        delete this.live[view];
        delete this.notices[view];
      }
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

  private open(view: View, stream: string): LiveStream<Frame> {
    return new LiveStream<Frame>(
      multiplexer,
      {
        wanted:
          view === 'map'
            ? { stream, includeReasons: true }
            : { stream, codec: sameMachine ? Codec.RAW : Codec.UNSPECIFIED },
        decode: (item) => decoder.decode(item),
        draw: (frame) => this.show(frame, useDisplay.getState(), browser.now_ms()),
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
