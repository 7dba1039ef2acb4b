import { Alert } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { ColorBar } from './ColorBar';
import { useDisplay } from './display';
import { ImageView } from './ImageView';
import { Inspector } from './Inspector';
import type { LiveScene } from './liveScene';
import { ReasonLegend } from './ReasonLegend';
import type { Pixel } from './scene';
import { StaleOverlay } from './StaleOverlay';
import { ViewToolbar } from './ViewToolbar';
import classes from './view.module.css';

interface Props {
  scene: LiveScene;
  /** "block.port" of what is shown; undefined: the sequence has none. */
  map: string | undefined;
  picture: string | undefined;
}

/** Picture and map side by side, with all that is known of a pixel. */
export function PicturePanel({ scene, map, picture }: Props) {
  const { t } = useTranslation('sequence');
  const showReasons = useDisplay((display) => display.showReasons);
  const choose = (pixel: Pixel) => scene.pin(pixel);
  if (!map && !picture) return <Alert>{t('noOutput')}</Alert>;
  return (
    <>
      <ViewToolbar scene={scene} />
      <div className={classes.pair}>
        {picture && (
          <ImageView
            scene={scene}
            what="picture"
            label={t('view.left', { output: picture })}
            onChoose={choose}
            onMoved={() => undefined}
          >
            <StaleOverlay scene={scene} view="picture" />
          </ImageView>
        )}
        {map && (
          <ImageView
            scene={scene}
            what="map"
            label={t('view.depth', { output: map })}
            onChoose={choose}
            onMoved={() => undefined}
          >
            <StaleOverlay scene={scene} view="map" />
          </ImageView>
        )}
        {map && <ColorBar scene={scene} />}
      </div>
      {map && showReasons && <ReasonLegend scene={scene} />}
      <Inspector scene={scene} />
    </>
  );
}
