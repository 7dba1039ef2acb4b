import { useEffect, useRef } from 'react';
import { useTranslation } from 'react-i18next';
import type { Output } from '../outputs';
import { LiveStream } from '../stream/liveStream';
import { browser, decoder, multiplexer } from '../stream/pageStreams';
import { AutoRange } from '../view/autoRange';
import { colorize, ColorTable } from '../view/colorize';
import { useDisplay } from '../view/display';
import type { Frame } from '../codec/frame';
import classes from './graph.module.css';

const kWidthPx = 160;
const kFps = 4;

/** A small live picture of an output; asks for nothing while it is not seen. */
export function Preview({ output }: { output: Output }) {
  const { t } = useTranslation('sequence');
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const element = canvas.current;
    if (!element) return;
    const draw = drawerOn(element);
    let live: LiveStream<Frame> | undefined;
    const seen = new IntersectionObserver(([entry]) => {
      if (!entry?.isIntersecting) {
        live?.end();
        live = undefined;
        return;
      }
      live ??= new LiveStream<Frame>(
        multiplexer,
        {
          wanted: { stream: output.stream, maxWidthPx: kWidthPx, maxFps: kFps, window: 1 },
          decode: (item) => decoder.decode(item),
          draw,
          release: (frame) => {
            if (frame.kind === 'picture') frame.bitmap.close();
          },
        },
        browser,
      );
    });
    seen.observe(element);
    return () => {
      seen.disconnect();
      live?.end();
    };
  }, [output.stream]);
  return (
    <canvas
      ref={canvas}
      className={classes.preview}
      role="img"
      aria-label={t('graph.preview', { output: output.path })}
      data-testid={`preview-${output.path}`}
    />
  );
}

function drawerOn(canvas: HTMLCanvasElement): (frame: Frame) => void {
  const context = canvas.getContext('2d', { alpha: false })!;
  const colors = new ColorTable();
  let range: AutoRange | undefined;
  return (frame) => {
    if (canvas.width !== frame.width || canvas.height !== frame.height) {
      canvas.width = frame.width;
      canvas.height = frame.height;
    }
    if (frame.kind === 'picture') {
      context.drawImage(frame.bitmap, 0, 0);
      frame.bitmap.close();
    } else {
      range ??= new AutoRange(frame.kind === 'disparity');
      const shown = range.follow(frame.stored, browser.now_ms()) ?? { far: 0, near: 65535 };
      const pixels = context.createImageData(frame.width, frame.height);
      const table = colors.of(useDisplay.getState().colorMap, shown);
      colorize(frame.stored, undefined, table, new Uint32Array(pixels.data.buffer));
      context.putImageData(pixels, 0, 0);
    }
    canvas.dataset.frame = String(frame.frameNumber);
  };
}
