import { useTranslation } from 'react-i18next';
import { cssColor } from './colorMap';
import { useDisplay } from './display';
import { depth_m, storedOf } from './geometry';
import type { Scene } from './scene';
import { type Tick, ticks } from './ticks';
import { useEvery } from './useEvery';
import classes from './view.module.css';

const kSteps = 32;
const kTicks = 8;

/** Which colour is which depth. Even in what the map holds: disparities, or metres of a depth map. */
export function ColorBar({ scene }: { scene: Scene }) {
  const { t, i18n } = useTranslation('sequence');
  const colorMap = useDisplay((display) => display.colorMap);
  const shown = useEvery(250, () => ticksOf(scene));
  const format = new Intl.NumberFormat(i18n.language, { maximumSignificantDigits: 4 });
  const stops = Array.from({ length: kSteps + 1 }, (_, i) => cssColor(colorMap, i / kSteps));
  const values = shown.map(({ value }) => format.format(value)).join(', ');
  return (
    <div className={classes.colorBar} role="img" aria-label={t('view.colorBar', { values })}>
      <div
        className={classes.colorRamp}
        style={{ background: `linear-gradient(to top, ${stops.join(', ')})` }}
      />
      <div className={classes.colorTicks}>
        {shown.map(({ value, place }) => (
          <span key={value} style={{ bottom: `${place * 100}%` }}>
            {format.format(value)}
          </span>
        ))}
      </div>
      <span className={classes.colorUnit}>m</span>
    </div>
  );
}

/** From the farthest (place 0) to the nearest (place 1). */
function ticksOf({ map, range }: Scene): Tick[] {
  if (!map || !range) return [];
  const { far, near } = range;
  return ticks(
    (place) => depth_m(map, far + place * (near - far)),
    (value) => (storedOf(map, value) - far) / (near - far),
    kTicks,
  );
}
