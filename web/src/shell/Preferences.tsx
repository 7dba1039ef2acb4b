import { ActionIcon, SegmentedControl, useMantineColorScheme, VisuallyHidden } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { type Language, languages, setLanguage } from '../i18n';
import { MoonIcon, SunIcon } from './icons';

/** Language and theme; both are remembered by the browser. */
export function Preferences() {
  const { t, i18n } = useTranslation('shell');
  const { colorScheme, setColorScheme } = useMantineColorScheme();
  const other = colorScheme === 'light' ? 'dark' : 'light';
  return (
    <>
      <SegmentedControl
        size="xs"
        aria-label={t('language')}
        value={i18n.language}
        onChange={(language) => void setLanguage(language as Language)}
        data={languages.map((language) => ({
          value: language,
          label: (
            <>
              <span aria-hidden>{language.toUpperCase()}</span>
              <VisuallyHidden>{{ en: 'English', de: 'Deutsch' }[language]}</VisuallyHidden>
            </>
          ),
        }))}
      />
      <ActionIcon
        variant="default"
        size="md"
        aria-label={t(other === 'light' ? 'theme.light' : 'theme.dark')}
        title={t(other === 'light' ? 'theme.light' : 'theme.dark')}
        onClick={() => setColorScheme(other)}
      >
        {other === 'light' ? <SunIcon /> : <MoonIcon />}
      </ActionIcon>
    </>
  );
}
