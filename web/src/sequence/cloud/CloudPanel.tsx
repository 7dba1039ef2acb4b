import { Alert, Button, Group, Switch } from '@mantine/core';
import { useEffect, useRef, useState } from 'react';
import { useTranslation } from 'react-i18next';
import { SaveMenu } from '../save/SaveMenu';
import { ColorBar } from '../view/ColorBar';
import type { LiveScene } from '../view/liveScene';
import { MeasureButton } from '../view/MeasureButton';
import { RangeFields } from '../view/RangeFields';
import { StaleOverlay } from '../view/StaleOverlay';
import { Choice } from '../view/Choice';
import { ColorMapChoice } from '../view/ColorMapChoice';
import classes from './cloud.module.css';
import { colorings } from './cloudMaterial';
import { type CloudOptions, CloudRenderer } from './cloudRenderer';
import { useCloudMeasuring } from './useCloudMeasuring';
import { webGl } from './webGl';

interface Props {
  sequence: string;
  scene: LiveScene;
  measuring: boolean;
  setMeasuring: (measuring: boolean) => void;
}

/** The newest map as points in space. */
export default function CloudPanel({ sequence, scene, measuring, setMeasuring }: Props) {
  const { t } = useTranslation('sequence');
  const host = useRef<HTMLDivElement>(null);
  const renderer = useRef<CloudRenderer>(undefined);
  const [drawnBy] = useState(webGl);
  const [options, setOptions] = useState<CloudOptions>({
    coloring: 'depth',
    pointSize_px: 2,
    axes: true,
    // Without a graphics card all points at once would be a slide show.
    step: drawnBy === 'software' ? 2 : 1,
  });
  const change = (part: Partial<CloudOptions>) => setOptions((now) => ({ ...now, ...part }));

  useEffect(() => {
    const element = host.current;
    if (!element) return;
    const made = new CloudRenderer(element, scene);
    renderer.current = made;
    const sizes = new ResizeObserver(([entry]) => {
      if (entry) made.resize(entry.contentRect.width, entry.contentRect.height);
    });
    sizes.observe(element);
    return () => {
      sizes.disconnect();
      made.end();
      renderer.current = undefined;
    };
  }, [scene]);

  useEffect(() => renderer.current?.setOptions(options), [options, scene]);

  useCloudMeasuring(host, renderer, scene, measuring);

  const byDepth = options.coloring === 'depth';
  if (drawnBy === 'none') return <Alert color="yellow">{t('cloud.noWebGl')}</Alert>;
  return (
    <>
      <Group gap="sm" role="toolbar" aria-label={t('cloud.toolbar')}>
        <Choice
          label={t('cloud.coloring')}
          help={options.coloring === 'height' ? t('cloud.heightHelp') : undefined}
          value={options.coloring}
          choices={colorings.map((value) => [value, t(`cloud.by.${value}`)])}
          onChoose={(coloring) => change({ coloring })}
        />
        {options.coloring !== 'picture' && <ColorMapChoice />}
        {byDepth && <RangeFields scene={scene} />}
        <Choice
          label={t('cloud.density')}
          value={String(options.step)}
          choices={[1, 2, 3, 4].map((step) => [
            String(step),
            step === 1 ? t('cloud.all') : t('cloud.every', { count: step * step }),
          ])}
          onChoose={(step) => change({ step: Number(step) })}
        />
        <label className={classes.size}>
          {t('cloud.pointSize')}
          <input
            type="range"
            min={1}
            max={8}
            step={0.5}
            value={options.pointSize_px}
            onChange={(event) => change({ pointSize_px: Number(event.currentTarget.value) })}
          />
        </label>
        <Switch
          size="xs"
          label={t('cloud.axes')}
          checked={options.axes}
          onChange={(event) => change({ axes: event.currentTarget.checked })}
        />
        <Button size="compact-sm" variant="default" onClick={() => renderer.current?.reset()}>
          {t('cloud.reset')}
        </Button>
        <MeasureButton scene={scene} on={measuring} setOn={setMeasuring} />
        <SaveMenu sequence={sequence} scene={scene} />
      </Group>
      <div className={classes.row}>
        <div className={classes.box}>
          <div
            ref={host}
            className={classes.cloud}
            tabIndex={0}
            role="img"
            aria-label={t('cloud.label')}
            data-testid="view-cloud"
            onKeyDown={(event) => {
              if (event.key === '+' || event.key === '=') renderer.current?.zoom(true);
              if (event.key === '-') renderer.current?.zoom(false);
              if (event.key === '0') renderer.current?.reset();
            }}
          />
          <StaleOverlay scene={scene} view="map" />
        </div>
        {byDepth && <ColorBar scene={scene} />}
      </div>
      <p className={classes.help}>{t('cloud.help')}</p>
    </>
  );
}
