// Values of the API as JavaScript has them, and as text.
import type { MessageInitShape } from '@bufbuild/protobuf';

import type { Result } from '../gen/visionserver/v1/result_pb';
import type { Value, ValueSchema } from '../gen/visionserver/v1/value_pb';

export type ValueInit = MessageInitShape<typeof ValueSchema>;

export function intValue(value: bigint): ValueInit {
  return { kind: { case: 'intValue', value } };
}

export function stringValue(value: string): ValueInit {
  return { kind: { case: 'stringValue', value } };
}

// NaN for what is no number. Integers beyond 2^53 lose their last digits.
export function toNumber(value: Value | undefined): number {
  if (value?.kind.case === 'doubleValue') return value.kind.value;
  if (value?.kind.case === 'intValue') return Number(value.kind.value);
  return NaN;
}

// 0 for what is no integer.
export function toBigint(value: Value | undefined): bigint {
  return value?.kind.case === 'intValue' ? value.kind.value : 0n;
}

// Empty for what is no text.
export function toText(value: Value | undefined): string {
  return value?.kind.case === 'stringValue' ? value.kind.value : '';
}

export function isNumber(value: Value | undefined): boolean {
  return value?.kind.case === 'doubleValue' || value?.kind.case === 'intValue';
}

// For people: numbers with at most six significant digits after the point's place, unless `exact`.
export function valueText(value: Value | undefined, exact = false): string {
  const kind = value?.kind;
  switch (kind?.case) {
    case 'boolValue':
    case 'intValue':
      return String(kind.value);
    case 'doubleValue':
      return exact ? String(kind.value) : String(Number(kind.value.toPrecision(6)));
    case 'stringValue':
      return kind.value;
    case 'bytesValue':
      return Array.from(kind.value, (byte) => byte.toString(16).padStart(2, '0')).join(' ');
    case 'listValue':
      return `[${kind.value.values.map((item) => valueText(item, exact)).join(', ')}]`;
    case 'tableValue':
      return `${kind.value.rows.length} x ${kind.value.columns.length}`;
    default:
      return '–';
  }
}

// The names of all fields that hold a number in one of the results, sorted.
export function numericFields(results: Result[]): string[] {
  const names = new Set<string>();
  for (const { fields } of results) {
    for (const field of fields) if (isNumber(field.value)) names.add(field.name);
  }
  return [...names].sort();
}

// The fields that name a file as the block SaveImages writes it.
export function fileFields(result: Result): string[] {
  return result.fields
    .filter((field) => /\.(png|ply)$/i.test(toText(field.value)))
    .map((field) => field.name);
}
