import { Alert, Group } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { SaveMenu } from '../save/SaveMenu';
import { ColorBar } from './ColorBar';
import { useDisplay } from './display';
import { ImageView } from './ImageView';
import { Inspector } from './Inspector';
import type { LiveScene } from './liveScene';
import { MeasureButton } from './MeasureButton';
import { ReasonLegend } from './ReasonLegend';
import type { Pixel } from './scene';
import { StaleOverlay } from './StaleOverlay';
import { ViewToolbar } from './ViewToolbar';
import classes from './view.module.css';

interface Props {
  sequence: string;
  scene: LiveScene;
  measuring: boolean;
  setMeasuring: (measuring: boolean) => void;
  /** "block.port" of what is shown; undefined: the sequence has none. */
  map: string | undefined;
  picture: string | undefined;
}

/** Picture and map side by side, with all that is known of a pixel. */
export function PicturePanel(props: Props) {
  const { sequence, scene, map, picture, measuring, setMeasuring } = props;
  const { t } = useTranslation('sequence');
  const showReasons = useDisplay((display) => display.showReasons);
  const choose = (pixel: Pixel) => (measuring ? scene.mark(pixel) : scene.pin(pixel));
  if (!map && !picture) return <Alert>{t('noOutput')}</Alert>;
  return (
    <>
      <Group gap="sm">
        <ViewToolbar scene={scene} maps={map !== undefined} />
        {map && <MeasureButton scene={scene} on={measuring} setOn={setMeasuring} />}
        <SaveMenu sequence={sequence} scene={scene} />
      </Group>
      <div className={classes.pair}>
        {picture && (
          <ImageView
            scene={scene}
            what="picture"
            label={t('view.left', { output: picture })}
            onChoose={choose}
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
