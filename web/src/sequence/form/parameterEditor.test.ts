// @vitest-environment node
import { create } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { ParameterSchema } from '../../gen/visionserver/v1/parameter_pb';
import {
  type ParameterInfo,
  ParameterInfoSchema,
  ParameterType,
} from '../../gen/visionserver/v1/sequence_pb';
import { ValueSchema } from '../../gen/visionserver/v1/value_pb';
import { settle } from '../stream/testing';
import { type Confirmed, type ParameterCalls, ParameterEditor } from './parameterEditor';
import { sliderScale } from './sliderScale';
import { parseNumber, type Plain, valueOf } from './value';

const info = (init: Partial<Omit<ParameterInfo, '$typeName' | '$unknown'>>) =>
  create(ParameterInfoSchema, { type: ParameterType.INT, min: 0, max: 255, ...init });

const kInitial = 5;

/** A server whose answers wait for the test. */
class FakeParameters implements ParameterCalls {
  stored: Record<string, number> = { 'match.p1': 10, 'match.p2': 100 };
  max = 255;
  sent: string[] = [];
  frame = 40n;
  private answers: (() => void)[] = [];

  list() {
    const parameters = Object.entries(this.stored).map(([path, value]) =>
      create(ParameterSchema, {
        path,
        info: info({
          name: path.split('.')[1],
          max: this.max,
          initial: create(ValueSchema, valueOf(ParameterType.INT, kInitial)),
        }),
        value: valueOf(ParameterType.INT, value),
      }),
    );
    return this.later(() => parameters);
  }

  set(path: string, _info: ParameterInfo, value: Plain) {
    this.sent.push(`${path} = ${String(value)}`);
    return this.later(() => {
      if (Number(value) > 255) throw new Error('p2 must be 0 to 255');
      this.stored[path] = Number(value);
      return this.confirmed([path]);
    });
  }

  reset(paths: string[]) {
    this.sent.push(`reset ${paths.join(' ')}`);
    return this.later(() => {
      for (const path of paths) this.stored[path] = kInitial;
      return this.confirmed(paths);
    });
  }

  textOf(error: unknown): string {
    return (error as Error).message;
  }

  async answer(): Promise<void> {
    this.answers.shift()!();
    await settle();
  }

  private confirmed(paths: string[]): Confirmed {
    return {
      appliedAtFrame: ++this.frame,
      values: paths.map((path) => ({
        path,
        value: create(ValueSchema, valueOf(ParameterType.INT, this.stored[path]!)),
      })),
    };
  }

  private later<T>(give: () => T): Promise<T> {
    return new Promise((resolve, reject) => {
      this.answers.push(() => {
        try {
          resolve(give());
        } catch (error) {
          reject(new Error(error instanceof Error ? error.message : String(error)));
        }
      });
    });
  }
}

async function loaded() {
  const calls = new FakeParameters();
  const editor = new ParameterEditor(calls);
  void editor.load();
  await calls.answer();
  return { calls, editor };
}

describe('ParameterEditor', () => {
  it('shows what the server has', async () => {
    const { editor } = await loaded();
    expect(editor.paths()).toEqual(['match.p1', 'match.p2']);
    expect(editor.field('match.p2')).toMatchObject({ value: 100, draft: undefined, error: '' });
  });

  it('sends one call at a time with the newest value while a slider is dragged', async () => {
    const { calls, editor } = await loaded();
    for (const value of [101, 102, 103, 104]) editor.edit('match.p2', value);
    expect(calls.sent).toEqual(['match.p2 = 101']);
    await calls.answer();
    expect(calls.sent).toEqual(['match.p2 = 101', 'match.p2 = 104']);
    await calls.answer();
    expect(calls.sent).toHaveLength(2);
  });

  it('keeps the value as confirmed until the server has answered', async () => {
    const { calls, editor } = await loaded();
    editor.edit('match.p2', 120);
    expect(editor.field('match.p2')).toMatchObject({ value: 100, draft: 120 });
    await calls.answer();
    expect(editor.field('match.p2')).toMatchObject({
      value: 120,
      draft: undefined,
      appliedAtFrame: 41n,
    });
  });

  it('snaps back with the words of the server when it refuses', async () => {
    const { calls, editor } = await loaded();
    editor.edit('match.p2', 300);
    await calls.answer();
    expect(editor.field('match.p2')).toMatchObject({
      value: 100,
      draft: undefined,
      error: 'p2 must be 0 to 255',
    });
    editor.edit('match.p2', 110);
    expect(editor.field('match.p2')!.error).toBe('');
  });

  it('says nothing of a refusal that is out of date', async () => {
    const { calls, editor } = await loaded();
    editor.edit('match.p2', 300);
    editor.edit('match.p2', 50);
    await calls.answer();
    expect(editor.field('match.p2')).toMatchObject({ value: 100, draft: 50, error: '' });
    await calls.answer();
    expect(editor.field('match.p2')).toMatchObject({ value: 50, draft: undefined });
  });

  it('shows what others change', async () => {
    const { calls, editor } = await loaded();
    const untouched = editor.field('match.p1');
    calls.stored['match.p2'] = 7;
    void editor.load();
    await calls.answer();
    expect(editor.field('match.p2')!.value).toBe(7);
    expect(editor.field('match.p1')).toBe(untouched);
  });

  it('shows a parameter whose description has changed', async () => {
    const { calls, editor } = await loaded();
    calls.max = 63;
    void editor.load();
    await calls.answer();
    expect(editor.field('match.p1')!.info.max).toBe(63);
  });

  it('leaves out a list that was made before a change of its own', async () => {
    const { calls, editor } = await loaded();
    void editor.load();
    editor.edit('match.p2', 120);
    const before = calls.stored['match.p2'];
    await calls.answer();
    expect(before).toBe(100);
    expect(editor.field('match.p2')).toMatchObject({ value: 100, draft: 120 });
    await calls.answer();
    expect(editor.field('match.p2')!.value).toBe(120);
  });

  it('resets, and forgets what was still to be sent', async () => {
    const { calls, editor } = await loaded();
    void editor.reset(['match.p1', 'match.p2']);
    expect(editor.field('match.p1')).toMatchObject({ value: 10, draft: 5 });
    await calls.answer();
    expect(calls.sent).toEqual(['reset match.p1 match.p2']);
    expect(editor.field('match.p1')).toMatchObject({
      value: 5,
      draft: undefined,
      appliedAtFrame: 41n,
    });
  });
});

describe('sliders', () => {
  it('have a place for each whole number of a short range', () => {
    const scale = sliderScale(info({ min: -10, max: 30 }))!;
    expect(scale.positions).toBe(40);
    expect(scale.valueAt(0)).toBe(-10);
    expect(scale.positionOf(30)).toBe(40);
  });

  it('spread a wide range, so that small values can be chosen', () => {
    const initial = create(ValueSchema, valueOf(ParameterType.INT, 100));
    const scale = sliderScale(info({ min: 0, max: 1_000_000, initial }))!;
    expect(scale.positionOf(100)).toBe(300);
    expect(scale.valueAt(0)).toBe(0);
    expect(scale.valueAt(1000)).toBe(1_000_000);
    expect(scale.valueAt(300)).toBe(100);
  });

  it('give round numbers within the range', () => {
    const initial = create(ValueSchema, valueOf(ParameterType.DOUBLE, 1));
    const scale = sliderScale(info({ type: ParameterType.DOUBLE, min: 0.0625, max: 16, initial }))!;
    expect(scale.valueAt(0)).toBe(0.0625);
    expect(scale.valueAt(1000)).toBe(16);
    expect(scale.valueAt(500)).toBe(8.03);
  });

  it('need both ends', () => {
    expect(sliderScale(info({ max: undefined }))).toBeUndefined();
  });
});

describe('typed numbers', () => {
  it('may have a point or a comma', () => {
    expect(parseNumber(' 1.5 ')).toBe(1.5);
    expect(parseNumber('-1,5')).toBe(-1.5);
    expect(parseNumber('1e-3')).toBe(0.001);
  });

  it('are refused when they are none', () => {
    for (const text of ['', 'x', '1.2.3', '1 000', '0x10']) expect(parseNumber(text)).toBeUndefined();
  });
});
