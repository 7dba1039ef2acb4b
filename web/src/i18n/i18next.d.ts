import 'i18next';
import type { texts } from './texts';

// Makes the compiler check every key that is asked for.
declare module 'i18next' {
  interface CustomTypeOptions {
    defaultNS: 'shell';
    resources: { [folder in keyof typeof texts]: (typeof texts)[folder]['en'] };
  }
}
