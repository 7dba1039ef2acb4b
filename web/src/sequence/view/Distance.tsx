import { useEffect, useRef } from 'react';
import { useTranslation } from 'react-i18next';
import { number } from './format';
import { distance, pointOf } from './geometry';
import type { Scene } from './scene';
import classes from './view.module.css';

/** The distance of the two marked pixels, as the newest map has it. */
export function Distance({ scene }: { scene: Scene }) {
  const { t, i18n } = useTranslation('sequence');
  const output = useRef<HTMLOutputElement>(null);
  useEffect(() => {
    const write = () => {
      if (output.current) output.current.textContent = textOf();
    };
    const textOf = () => {
      const { map, marks } = scene;
      if (marks.length < 2 || !map) return t(marks.length === 1 ? 'measure.second' : 'measure.first');
      const [a, b] = marks.map(({ x, y }) => pointOf(map, x, y));
      if (!a || !b) return t('measure.invalid');
      const { distance_m, uncertainty_m } = distance(map, a, b);
      return t('measure.result', {
        distance: number(distance_m, 4, i18n.language),
        uncertainty: number(uncertainty_m, 4, i18n.language),
      });
    };
    write();
    const endings = [scene.mapChanged.on(write), scene.marksChanged.on(write)];
    return () => endings.forEach((end) => end());
  }, [scene, t, i18n.language]);
  return (
    <output
      ref={output}
      className={classes.distance}
      title={t('measure.help')}
      data-testid="distance"
    />
  );
}
