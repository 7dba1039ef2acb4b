import i18next from 'i18next';
import { initReactI18next } from 'react-i18next';
import * as shell from '../shell/text';
import type { texts } from './texts';

const kStorageKey = 'visionserver.language';

/** The languages that all texts exist in. */
export const languages = ['en', 'de'] as const;
export type Language = (typeof languages)[number];

function isLanguage(text: string | null | undefined): text is Language {
  return languages.some((language) => language === text);
}

/** What was chosen here before, else what the browser asks for, else English. */
function initialLanguage(): Language {
  const stored = localStorage.getItem(kStorageKey);
  if (isLanguage(stored)) return stored;
  return navigator.languages.map((tag) => tag.slice(0, 2)).find(isLanguage) ?? 'en';
}

/** Makes the texts of a folder known; each page's come with the page (see routes.tsx). */
export function addTexts<Folder extends keyof typeof texts>(
  folder: Folder,
  text: (typeof texts)[Folder],
): void {
  for (const language of languages) i18next.addResourceBundle(language, folder, text[language]);
}

/** Chooses the language of the page and remembers it. */
export async function setLanguage(language: Language): Promise<void> {
  localStorage.setItem(kStorageKey, language);
  await i18next.changeLanguage(language);
}

/** How the user writes dates in the language of the page: British, say, where the browser is so. */
export function userLocale(): string {
  const { language } = i18next;
  return navigator.languages.find((tag) => tag.split('-')[0] === language) ?? language;
}

i18next.on('languageChanged', (language) => {
  document.documentElement.lang = language;
});

await i18next.use(initReactI18next).init({
  lng: initialLanguage(),
  fallbackLng: 'en',
  ns: ['shell'],
  defaultNS: 'shell',
  resources: { en: { shell: shell.en }, de: { shell: shell.de } },
  interpolation: { escapeValue: false }, // React escapes
});

export { i18next };
