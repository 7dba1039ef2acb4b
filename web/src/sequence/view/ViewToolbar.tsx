import { ActionIcon, Group, NumberInput, Select, Switch, Tooltip } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { colorMaps } from './colorMap';
import { useDisplay } from './display';
import { depth_m } from './geometry';
import type { Scene } from './scene';

const ZOOM_STEP = 1.5;

/** How maps are coloured, and zoom by buttons. */
export function ViewToolbar({ scene }: { scene: Scene }) {
  const { t } = useTranslation('sequence');
  const { colorMap, fixedRange, showReasons, set } = useDisplay();

  // The fixed range begins as what the automatic one shows, on round numbers.
  const fixRange = (fixed: boolean) => {
    const { map, range } = scene;
    if (!fixed || !map || !range) {
      set({ fixedRange: undefined });
      return;
    }
    const round = (value: number) => Math.max(0.01, Math.round(value * 100) / 100);
    const near_m = round(depth_m(map, range.near));
    set({ fixedRange: { near_m, far_m: Math.max(round(depth_m(map, range.far)), near_m + 0.01) } });
  };
  const limit = (change: { near_m?: number; far_m?: number }) => {
    if (!fixedRange) return;
    const next = { ...fixedRange, ...change };
    if (next.near_m > 0 && next.near_m < next.far_m) set({ fixedRange: next });
  };
  const field = (value: number, label: string, key: 'near_m' | 'far_m') => (
    <NumberInput
      key={key}
      size="xs"
      w={92}
      value={value}
      onChange={(next) => limit({ [key]: Number(next) })}
      min={0.01}
      max={1000}
      step={0.05}
      decimalScale={3}
      suffix=" m"
      aria-label={label}
    />
  );

  return (
    <Group gap="sm" role="toolbar" aria-label={t('view.toolbar')}>
      <Select
        size="xs"
        w={110}
        aria-label={t('view.colorMap')}
        data={colorMaps.map((value) => ({ value, label: t(`colorMap.${value}`) }))}
        value={colorMap}
        onChange={(value) => value && set({ colorMap: value })}
        allowDeselect={false}
      />
      <Switch
        size="xs"
        label={t('view.fixedRange')}
        checked={fixedRange !== undefined}
        onChange={(event) => fixRange(event.currentTarget.checked)}
      />
      {fixedRange && field(fixedRange.near_m, t('view.near'), 'near_m')}
      {fixedRange && field(fixedRange.far_m, t('view.far'), 'far_m')}
      <Switch
        size="xs"
        label={t('view.showInvalid')}
        checked={showReasons}
        onChange={(event) => set({ showReasons: event.currentTarget.checked })}
      />
      <ActionIcon.Group>
        <ZoomButton label={t('view.zoomOut')} sign="–" onClick={() => scene.viewport.zoom(1 / ZOOM_STEP)} />
        <ZoomButton label={t('view.fit')} sign="⤢" onClick={() => scene.viewport.fit()} />
        <ZoomButton label={t('view.zoomIn')} sign="+" onClick={() => scene.viewport.zoom(ZOOM_STEP)} />
      </ActionIcon.Group>
    </Group>
  );
}

function ZoomButton(props: { label: string; sign: string; onClick: () => void }) {
  return (
    <Tooltip label={props.label}>
      <ActionIcon variant="default" size="md" aria-label={props.label} onClick={props.onClick}>
        {props.sign}
      </ActionIcon>
    </Tooltip>
  );
}
