import { type ParameterInfo, ParameterType } from '../../gen/visionserver/v1/sequence_pb';
import { plainOf } from './value';

/** The positions of a slider and the values that they stand for. */
export interface SliderScale {
  positions: number;
  valueAt(position: number): number;
  positionOf(value: number): number;
}

const POSITIONS = 1000;
// The initial value of a wide range is brought to this part of the slider.
const INITIAL_PLACE = 0.3;
const WIDE = 0.05;

/**
 * A slider for a number with both ends; undefined for others. A range whose initial value lies far
 * at its lower end (100 of 0 to 1000000) is spread by a power, so that small values can be chosen.
 */
export function sliderScale(info: ParameterInfo): SliderScale | undefined {
  const { min, max, type } = info;
  if (min === undefined || max === undefined || !(max > min)) return undefined;
  const span = max - min;
  const whole = type === ParameterType.INT;
  const initial = Number(plainOf(info.initial) ?? min);
  const place = (initial - min) / span;
  const power = place > 0 && place < WIDE ? Math.log(place) / Math.log(INITIAL_PLACE) : 1;
  if (whole && power === 1 && span <= POSITIONS) {
    return {
      positions: span,
      valueAt: (position) => min + position,
      positionOf: (value) => value - min,
    };
  }
  return {
    positions: POSITIONS,
    valueAt: (position) => {
      const value = min + span * (position / POSITIONS) ** power;
      return whole ? Math.round(value) : Math.min(Math.max(round(value, span), min), max);
    },
    positionOf: (value) =>
      Math.round(POSITIONS * Math.min(Math.max((value - min) / span, 0), 1) ** (1 / power)),
  };
}

/** To three digits of what matters: of the value itself, or of the range where that is smaller. */
function round(value: number, span: number): number {
  const size = Math.min(Math.abs(value) || span, span);
  const step = 10 ** (Math.floor(Math.log10(size)) - 2);
  return Number((Math.round(value / step) * step).toPrecision(12));
}
