import { ActionIcon, Group, Switch } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { ColorMapChoice } from './ColorMapChoice';
import { RangeFields } from './RangeFields';
import { useDisplay } from './display';
import type { Scene } from './scene';
import classes from './view.module.css';

const kZoomStep = 1.5;

interface Props {
  scene: Scene;
  /** There are maps, which have colours and invalid pixels. */
  maps: boolean;
}

/** How maps are coloured, and zoom by buttons. */
export function ViewToolbar({ scene, maps }: Props) {
  const { t } = useTranslation('sequence');
  const { showReasons, set } = useDisplay();
  const { viewport } = scene;
  const buttons = [
    ['–', t('view.zoomOut'), () => viewport.zoom(1 / kZoomStep)],
    ['⤢', t('view.fit'), () => viewport.fit()],
    ['+', t('view.zoomIn'), () => viewport.zoom(kZoomStep)],
  ] as const;
  return (
    <Group gap="sm" role="toolbar" className={classes.toolbar} aria-label={t('view.toolbar')}>
      {maps && (
        <>
          <ColorMapChoice />
          <RangeFields scene={scene} />
          <Switch
            size="xs"
            label={t('view.showInvalid')}
            checked={showReasons}
            onChange={(event) => set({ showReasons: event.currentTarget.checked })}
          />
        </>
      )}
      <ActionIcon.Group>
        {buttons.map(([sign, label, act]) => (
          <ActionIcon
            key={sign}
            variant="default"
            size="md"
            aria-label={label}
            title={label}
            onClick={act}
          >
            {sign}
          </ActionIcon>
        ))}
      </ActionIcon.Group>
    </Group>
  );
}
