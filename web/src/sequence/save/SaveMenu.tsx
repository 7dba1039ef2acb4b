import { Button, Menu } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { download } from '../../shell/download';
import { notifyError } from '../../shell/ErrorNote';
import type { Scene } from '../view/scene';
import { shownOf, snapshot, type SnapshotKind, snapshotKinds } from './snapshot';

/** Saves what is on the screen at this moment, in files that keep every bit. */
export function SaveMenu({ sequence, scene }: { sequence: string; scene: Scene }) {
  const { t } = useTranslation('sequence');
  const save = async (kinds: readonly SnapshotKind[]) => {
    try {
      // All of the same moment, however long writing takes.
      const shown = shownOf(scene);
      for (const kind of kinds) {
        const file = await snapshot(kind, sequence, shown);
        if (file) download(file.name, file.content);
      }
    } catch (error) {
      notifyError(error);
    }
  };
  return (
    <Menu position="bottom-start">
      <Menu.Target>
        <Button size="compact-sm" variant="default">
          {t('save.title')}
        </Button>
      </Menu.Target>
      <Menu.Dropdown>
        {snapshotKinds.map((kind) => (
          <Menu.Item key={kind} onClick={() => void save([kind])}>
            {t(`save.${kind}`)}
          </Menu.Item>
        ))}
        <Menu.Divider />
        <Menu.Item onClick={() => void save(snapshotKinds)}>{t('save.all')}</Menu.Item>
      </Menu.Dropdown>
    </Menu>
  );
}
