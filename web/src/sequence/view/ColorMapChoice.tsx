import { useTranslation } from 'react-i18next';
import { Choice } from './Choice';
import { colorMaps } from './colorMap';
import { useDisplay } from './display';

/** How near and far are coloured. */
export function ColorMapChoice() {
  const { t } = useTranslation('sequence');
  const { colorMap, set } = useDisplay();
  return (
    <Choice
      label={t('view.colorMap')}
      value={colorMap}
      choices={colorMaps.map((value) => [value, t(`colorMap.${value}`)])}
      onChoose={(chosen) => set({ colorMap: chosen })}
    />
  );
}
