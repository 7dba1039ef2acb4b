import { type ReactNode, useEffect, useRef } from 'react';
import { useTranslation } from 'react-i18next';
import classes from './view.module.css';
import { ImagePainter } from './imagePainter';
import { listenToPointing } from './pointing';
import type { Pixel, Scene } from './scene';

interface Props {
  scene: Scene;
  what: 'map' | 'picture';
  label: string;
  onChoose: (pixel: Pixel) => void;
  /** Lies over the picture. */
  children?: ReactNode;
}

/** One of the pictures that zoom and pan together. */
export function ImageView({ scene, what, label, onChoose, children }: Props) {
  const { t } = useTranslation('sequence');
  const canvas = useRef<HTMLCanvasElement>(null);
  const action = useRef(onChoose);
  useEffect(() => {
    action.current = onChoose;
  });

  useEffect(() => {
    const element = canvas.current;
    if (!element) return;
    const painter = new ImagePainter(element, scene, what);
    const sizes = new ResizeObserver(([entry]) => {
      if (entry) painter.resize(entry.contentRect.width, entry.contentRect.height);
    });
    sizes.observe(element.parentElement ?? element);
    const endPointing = listenToPointing(element, scene, (pixel) => action.current(pixel));
    return () => {
      endPointing();
      sizes.disconnect();
      painter.end();
    };
  }, [scene, what]);

  return (
    <figure className={classes.view}>
      <figcaption className={classes.caption} title={t('view.keys')}>
        {label}
      </figcaption>
      <div className={classes.canvasBox}>
        <canvas
          ref={canvas}
          className={classes.canvas}
          tabIndex={0}
          role="img"
          aria-label={label}
          aria-description={t('view.keys')}
          data-testid={`view-${what}`}
        />
        {children}
      </div>
    </figure>
  );
}
