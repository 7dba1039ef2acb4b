import { useTranslation } from 'react-i18next';
import { type ParameterInfo, ParameterType } from '../../gen/visionserver/v1/sequence_pb';
import { kNone } from '../../shell/format';
import type { Plain } from './value';

/** Whole numbers as they are, others to six digits, in the user's way of writing. */
export function numberText(value: number, type: ParameterType, language: string): string {
  const digits =
    type === ParameterType.INT ? { maximumFractionDigits: 0 } : { maximumSignificantDigits: 6 };
  return new Intl.NumberFormat(language, { ...digits, useGrouping: false }).format(value);
}

/** Says a parameter's value in words, with its unit. */
export function useValueText(): (info: ParameterInfo, value: Plain) => string {
  const { t, i18n } = useTranslation('sequence');
  return ({ type, unit }, value) => {
    if (typeof value === 'boolean') return t(value ? 'form.on' : 'form.off');
    if (typeof value === 'string') return value || kNone;
    return `${numberText(value, type, i18n.language)} ${unit}`.trimEnd();
  };
}
