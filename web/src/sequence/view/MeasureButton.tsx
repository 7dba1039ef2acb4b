import { Button, Group } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { Distance } from './Distance';
import type { Scene } from './scene';

interface Props {
  scene: Scene;
  on: boolean;
  setOn: (on: boolean) => void;
}

/** Turns measuring on and off; while on, a chosen pixel or point is the end of a distance. */
export function MeasureButton({ scene, on, setOn }: Props) {
  const { t } = useTranslation('sequence');
  return (
    <Group gap="xs">
      <Button
        size="compact-sm"
        variant={on ? 'filled' : 'default'}
        aria-pressed={on}
        onClick={() => {
          if (on) scene.clearMarks();
          setOn(!on);
        }}
      >
        {t('measure.title')}
      </Button>
      {on && <Distance scene={scene} />}
    </Group>
  );
}
