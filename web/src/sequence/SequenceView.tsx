import { Loader, Tabs } from '@mantine/core';
import { lazy, Suspense, useEffect, useMemo, useState } from 'react';
import { useTranslation } from 'react-i18next';
import type { BlockType, Sequence, SequenceSpec } from '../gen/visionserver/v1/sequence_pb';
import { hasBlocks } from '../shell/runState';
import { mainMap, mainPicture, outputsOf } from './outputs';
import classes from './page.module.css';
import { SequenceHeader } from './SequenceHeader';
import { useSequenceState } from './useSequenceState';
import { LiveScene } from './view/liveScene';
import { PicturePanel } from './view/PicturePanel';

// Not needed for the first picture; the latter two bring large libraries.
const ParameterForm = lazy(() => import('./form/ParameterForm'));
const GraphPanel = lazy(() => import('./graph/GraphPanel'));
const CloudPanel = lazy(() => import('./cloud/CloudPanel'));

interface Props {
  sequence: Sequence;
  spec: SequenceSpec;
  blockTypes: BlockType[];
}

/** The page of a sequence that is known. */
export function SequenceView({ sequence: { id }, spec, blockTypes }: Props) {
  const { t } = useTranslation('sequence');
  const [scene] = useState(() => new LiveScene());
  const [tab, setTab] = useState('pictures');
  const [measuring, setMeasuring] = useState(false);
  const [filter, setFilter] = useState('');
  const { data: state } = useSequenceState(id);
  const { outputs, map, picture } = useMemo(() => {
    const all = outputsOf(id, spec, blockTypes);
    const shown = mainMap(all, spec);
    return { outputs: all, map: shown, picture: mainPicture(all, spec, shown) };
  }, [id, spec, blockTypes]);
  // The graph has small pictures of its own.
  const watching = tab !== 'graph';
  useEffect(
    () => (watching ? scene.watch({ map: map?.stream, picture: picture?.stream }) : undefined),
    [scene, watching, map?.stream, picture?.stream],
  );

  return (
    <div className={classes.page}>
      <SequenceHeader id={id} description={spec.description} state={state} scene={scene} />
      <div className={classes.columns}>
        <Tabs
          value={tab}
          onChange={(next) => setTab(next ?? 'pictures')}
          keepMounted={false}
          className={classes.tabs}
        >
          <Tabs.List>
            <Tabs.Tab value="pictures">{t('tab.pictures')}</Tabs.Tab>
            {map && <Tabs.Tab value="cloud">{t('tab.cloud')}</Tabs.Tab>}
            <Tabs.Tab value="graph">{t('tab.graph')}</Tabs.Tab>
          </Tabs.List>
          <Tabs.Panel value="pictures" className={classes.panel}>
            <PicturePanel
              sequence={id}
              scene={scene}
              map={map?.path}
              picture={picture?.path}
              measuring={measuring}
              setMeasuring={setMeasuring}
            />
          </Tabs.Panel>
          <Tabs.Panel value="cloud" className={classes.panel}>
            <Suspense fallback={<Loader />}>
              <CloudPanel
                sequence={id}
                scene={scene}
                measuring={measuring}
                setMeasuring={setMeasuring}
              />
            </Suspense>
          </Tabs.Panel>
          <Tabs.Panel value="graph" className={classes.panel}>
            <Suspense fallback={<Loader />}>
              <GraphPanel
                spec={spec}
                blockTypes={blockTypes}
                outputs={outputs}
                state={state}
                onChoose={(block) => setFilter(`${block}.`)}
              />
            </Suspense>
          </Tabs.Panel>
        </Tabs>
        <aside className={classes.aside}>
          <Suspense fallback={<Loader />}>
            <ParameterForm
              sequence={id}
              spec={spec}
              blockTypes={blockTypes}
              running={hasBlocks(state?.state)}
              filter={filter}
              setFilter={setFilter}
            />
          </Suspense>
        </aside>
      </div>
    </div>
  );
}
