import { useTranslation } from 'react-i18next';
import { kNone } from '../shell/format';
import classes from './page.module.css';
import { number } from './view/format';
import type { LiveScene } from './view/liveScene';
import { useEvery } from './view/useEvery';

/** Rate, delay and losses of what is on the screen: of the map, or of the picture where none is. */
export function StreamFigures({ scene }: { scene: LiveScene }) {
  const { t, i18n } = useTranslation('sequence');
  const shown = useEvery(500, () => {
    const figures = scene.figures('map') ?? scene.figures('picture');
    if (!figures) return undefined;
    const { fps, latency_ms, dropped } = figures;
    return {
      fps: fps === undefined ? kNone : `${number(fps, 1, i18n.language)} /s`,
      latency: latency_ms === undefined ? kNone : `${number(latency_ms, 0, i18n.language)} ms`,
      dropped: String(dropped),
    };
  });
  if (!shown) return null;
  return (
    <dl className={classes.figures}>
      {(['fps', 'latency', 'dropped'] as const).map((name) => (
        <div key={name} title={t(`figures.${name}Help`)}>
          <dt>{t(`figures.${name}`)}</dt>
          <dd data-testid={name}>{shown[name]}</dd>
        </div>
      ))}
    </dl>
  );
}
