import { Group, Switch } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { TypedText } from '../form/TypedText';
import { parseNumber } from '../form/value';
import { useDisplay } from './display';
import { depth_m } from './geometry';
import type { Scene } from './scene';

const kLeastM = 0.01;
const kStepM = 0.05;

/** From which to which depth the colours run: as the map has it, or fixed. */
export function RangeFields({ scene }: { scene: Scene }) {
  const { t, i18n } = useTranslation('sequence');
  const format = new Intl.NumberFormat(i18n.language, { maximumFractionDigits: 3 });
  const { fixedRange, set } = useDisplay();
  const round = (value: number) => Math.max(kLeastM, Math.round(value * 100) / 100);

  // The fixed range begins as what the automatic one shows, on round numbers.
  const fix = (fixed: boolean) => {
    const { map, range } = scene;
    if (!fixed || !map || !range) {
      set({ fixedRange: undefined });
      return;
    }
    const near_m = round(depth_m(map, range.near));
    const far_m = Math.max(round(depth_m(map, range.far)), near_m + kLeastM);
    set({ fixedRange: { near_m, far_m } });
  };
  const change = (part: { near_m?: number; far_m?: number }): boolean => {
    const next = { near_m: 0, far_m: 0, ...fixedRange, ...part };
    const good = next.near_m > 0 && next.near_m < next.far_m && Number.isFinite(next.far_m);
    if (good) set({ fixedRange: next });
    return good;
  };
  const field = (name: 'near_m' | 'far_m', label: string) => (
    <TypedText
      style={{ width: 58, textAlign: 'right' }}
      inputMode="decimal"
      aria-label={label}
      title={label}
      value={format.format(fixedRange?.[name] ?? 0)}
      accept={(text) => change({ [name]: parseNumber(text) ?? NaN })}
      onStep={(direction, typed = '') => {
        const from = parseNumber(typed) ?? fixedRange?.[name] ?? 0;
        return change({ [name]: round(from + direction * kStepM) });
      }}
    />
  );

  return (
    <Group gap={6} wrap="nowrap">
      <Switch
        size="xs"
        label={t('view.fixedRange')}
        checked={fixedRange !== undefined}
        onChange={(event) => fix(event.currentTarget.checked)}
      />
      {fixedRange && (
        <>
          {field('near_m', t('view.near'))} –{field('far_m', t('view.far'))} m
        </>
      )}
    </Group>
  );
}
