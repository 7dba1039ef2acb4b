import { useTranslation } from 'react-i18next';
import { countReasons, reasonCss } from './reasons';
import type { Scene } from './scene';
import { useEvery } from './useEvery';
import classes from './view.module.css';

/** What the colours of invalid pixels mean, and how much of the map each of them is. */
export function ReasonLegend({ scene }: { scene: Scene }) {
  const { t, i18n } = useTranslation('sequence');
  const shares = useEvery(500, () => {
    const { map } = scene;
    if (!map?.reasons) return [];
    return countReasons(map.reasons).map(({ name, share }) => ({
      name,
      permille: Math.round(share * 1000),
    }));
  });
  const format = new Intl.NumberFormat(i18n.language, {
    style: 'percent',
    minimumFractionDigits: 1,
    maximumFractionDigits: 1,
  });
  return (
    <ul className={classes.legend} aria-label={t('view.legend')} data-testid="reason-legend">
      {shares.map(({ name, permille }) => (
        <li key={name}>
          <span className={classes.swatch} style={{ background: reasonCss(name) }} />
          {t(`reason.${name}`)} <span className={classes.share}>{format.format(permille / 1000)}</span>
        </li>
      ))}
    </ul>
  );
}
