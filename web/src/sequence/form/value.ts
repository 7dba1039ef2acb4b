import {
  type ParameterInfo,
  ParameterType,
} from '../../gen/visionserver/v1/sequence_pb';
import type { Value } from '../../gen/visionserver/v1/value_pb';

/** A parameter's value as the page works with it; whole numbers are exact up to 2^53. */
export type Plain = boolean | number | string;

/** Undefined for what no parameter can be (null, lists, tables). */
export function plainOf(value: Value | undefined): Plain | undefined {
  switch (value?.kind.case) {
    case 'boolValue':
    case 'doubleValue':
    case 'stringValue':
      return value.kind.value;
    case 'intValue':
      return Number(value.kind.value);
    default:
      return undefined;
  }
}

/** As the server wants it for a parameter of this type. */
export function valueOf(type: ParameterType, plain: Plain) {
  switch (type) {
    case ParameterType.BOOL:
      return { kind: { case: 'boolValue' as const, value: Boolean(plain) } };
    case ParameterType.INT:
      return { kind: { case: 'intValue' as const, value: BigInt(Math.round(Number(plain))) } };
    case ParameterType.DOUBLE:
      return { kind: { case: 'doubleValue' as const, value: Number(plain) } };
    default:
      return { kind: { case: 'stringValue' as const, value: String(plain) } };
  }
}

/** A typed number, with a point or a comma; undefined when it is none. */
export function parseNumber(text: string): number | undefined {
  const plain = text.trim().replace(',', '.').replace('−', '-');
  if (!/^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(plain)) return undefined;
  return Number(plain);
}

export function isNumber({ type }: ParameterInfo): boolean {
  return type === ParameterType.INT || type === ParameterType.DOUBLE;
}
