import { Loader } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import type { LiveScene, View } from './liveScene';
import { useEvery } from './useEvery';
import classes from './view.module.css';

/** Says over a view that what it shows is old, and why nothing comes. */
export function StaleOverlay({ scene, view }: { scene: LiveScene; view: View }) {
  const { t } = useTranslation('sequence');
  const state = useEvery(250, () => {
    const figures = scene.figures(view);
    return {
      watched: figures !== undefined,
      // Whole seconds, so that it renders once a second.
      stale_s: figures?.stale ? Math.floor((figures.age_ms ?? 0) / 1000) : undefined,
      first: figures !== undefined && figures.age_ms === undefined,
      notice: scene.notice(view),
    };
  });
  if (!state.watched || (!state.first && state.stale_s === undefined)) return null;
  return (
    <div className={state.first ? classes.waiting : classes.stale} role="status">
      {state.first && state.notice === '' && <Loader size="sm" />}
      <strong>
        {state.first ? t('view.waiting') : t('view.stale', { seconds: state.stale_s })}
      </strong>
      {state.notice && <span>{state.notice}</span>}
    </div>
  );
}
