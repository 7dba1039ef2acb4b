import { useMemo } from 'react';
import { useTranslation } from 'react-i18next';
import { ParameterType } from '../../gen/visionserver/v1/sequence_pb';
import classes from './form.module.css';
import type { ControlProps } from './ParameterControl';
import { sliderScale } from './sliderScale';
import { TypedText } from './TypedText';
import { parseNumber } from './value';
import { numberText } from './valueText';

const kLongestUnit = 4;

/** A slider whose knob is where the user wants it, and a number that says what the server has. */
export function NumberField({ field, id, disabled, onEdit }: ControlProps) {
  const { i18n } = useTranslation();
  const { info, value, draft } = field;
  const scale = useMemo(() => sliderScale(info), [info]);
  const text = (number: number) => numberText(number, info.type, i18n.language);
  return (
    <div className={classes.number}>
      {scale && (
        <input
          type="range"
          className={classes.slider}
          min={0}
          max={scale.positions}
          value={scale.positionOf(Number(draft ?? value))}
          disabled={disabled}
          aria-label={info.name}
          aria-describedby={`${id}-note`}
          aria-valuetext={`${text(Number(draft ?? value))} ${info.unit}`}
          onChange={(event) => onEdit(scale.valueAt(Number(event.currentTarget.value)))}
        />
      )}
      <TypedText
        id={id}
        className={classes.typed}
        inputMode="decimal"
        disabled={disabled}
        value={text(Number(value))}
        accept={(text) => {
          const typed = parseNumber(text);
          if (typed === undefined) return false;
          onEdit(info.type === ParameterType.INT ? Math.round(typed) : typed);
          return true;
        }}
        onStep={(direction, typed) => {
          const from = typed === undefined ? Number(draft ?? value) : parseNumber(typed);
          if (from === undefined) return false;
          const step = direction * stepOf(from, info.type);
          const next = Number((from + step).toPrecision(12));
          onEdit(Math.min(Math.max(next, info.min ?? -Infinity), info.max ?? Infinity));
          return true;
        }}
      />
      {/* Long ones stand below, with the range. */}
      <span className={classes.unit}>{info.unit.length <= kLongestUnit ? info.unit : ''}</span>
    </div>
  );
}

/** One for whole numbers; else about a hundredth of the value, on a round number. */
function stepOf(value: number, type: ParameterType): number {
  if (type === ParameterType.INT) return 1;
  return value === 0 ? 0.01 : 10 ** Math.floor(Math.log10(Math.abs(value)) - 1);
}
