import { Tabs } from '@mantine/core';
import { useEffect, useMemo, useState } from 'react';
import { useTranslation } from 'react-i18next';
import type { BlockType, Sequence } from '../gen/visionserver/v1/sequence_pb';
import { mainMap, mainPicture, outputsOf } from './outputs';
import classes from './page.module.css';
import { SequenceHeader } from './SequenceHeader';
import { LiveScene } from './view/liveScene';
import { PicturePanel } from './view/PicturePanel';

interface Props {
  sequence: Sequence;
  blockTypes: BlockType[];
}

/** The page of a sequence that is known. */
export function SequenceView({ sequence, blockTypes }: Props) {
  const { t } = useTranslation('sequence');
  const [scene] = useState(() => new LiveScene());
  const { map, picture } = useMemo(() => {
    if (!sequence.spec) return {};
    const outputs = outputsOf(sequence.id, sequence.spec, blockTypes);
    const shown = mainMap(outputs, sequence.spec);
    return { map: shown, picture: mainPicture(outputs, sequence.spec, shown) };
  }, [sequence, blockTypes]);
  useEffect(
    () => scene.watch({ map: map?.stream, picture: picture?.stream }),
    [scene, map?.stream, picture?.stream],
  );

  return (
    <div className={classes.page}>
      <SequenceHeader id={sequence.id} description={sequence.spec?.description ?? ''} scene={scene} />
      <Tabs defaultValue="pictures" keepMounted={false} className={classes.tabs}>
        <Tabs.List>
          <Tabs.Tab value="pictures">{t('tab.pictures')}</Tabs.Tab>
        </Tabs.List>
        <Tabs.Panel value="pictures" className={classes.panel}>
          <PicturePanel scene={scene} map={map?.path} picture={picture?.path} />
        </Tabs.Panel>
      </Tabs>
    </div>
  );
}
