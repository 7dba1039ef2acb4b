import { type ParameterInfo, ParameterType } from '../../gen/visionserver/v1/sequence_pb';
import { plainOf } from './value';

/** The positions of a slider and the values that they stand for. */
export interface SliderScale {
  positions: number;
  valueAt(position: number): number;
  positionOf(value: number): number;
}

const kPositions = 1000;
// The initial value of a wide range is brought to this part of the slider.
const kInitialPlace = 0.3;
const kWide = 0.05;

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
  const power = place > 0 && place < kWide ? Math.log(place) / Math.log(kInitialPlace) : 1;
  if (whole && power === 1 && span <= kPositions) {
    return {
      positions: span,
      valueAt: (position) => min + position,
      positionOf: (value) => value - min,
    };
  }
  return {
    positions: kPositions,
    valueAt: (position) => {
      const value = min + span * (position / kPositions) ** power;
      return whole ? Math.round(value) : Math.min(Math.max(round(value, span), min), max);
    },
    positionOf: (value) =>
      Math.round(kPositions * Math.min(Math.max((value - min) / span, 0), 1) ** (1 / power)),
  };
}

/** To three digits of what matters: of the value itself, or of the range where that is smaller. */
function round(value: number, span: number): number {
  const size = Math.min(Math.abs(value) || span, span);
  const step = 10 ** (Math.floor(Math.log10(size)) - 2);
  return Number((Math.round(value / step) * step).toPrecision(12));
}
