import { equals } from '@bufbuild/protobuf';
import type { Parameter } from '../../gen/visionserver/v1/parameter_pb';
import { type ParameterInfo, ParameterInfoSchema } from '../../gen/visionserver/v1/sequence_pb';
import type { Value } from '../../gen/visionserver/v1/value_pb';
import { Signal } from '../view/signal';
import { type Plain, plainOf } from './value';

/** One parameter as the form shows it. Replaced, never changed. */
export interface Field {
  /** "block.parameter". */
  readonly path: string;
  readonly info: ParameterInfo;
  /** What the server has confirmed. */
  readonly value: Plain;
  /** What the user wants and the server has not confirmed yet; a slider's knob is there. */
  readonly draft: Plain | undefined;
  /** Why the server refused the last change; empty when it did not. */
  readonly error: string;
  /** First frame with the value that was set here; undefined when it was not, or nothing ran. */
  readonly appliedAtFrame: bigint | undefined;
}

export interface Confirmed {
  appliedAtFrame: bigint;
  values: { path: string; value?: Value }[];
}

/** What the editor needs of ParameterService, for one sequence. */
export interface ParameterCalls {
  list(): Promise<Parameter[]>;
  set(path: string, info: ParameterInfo, value: Plain): Promise<Confirmed>;
  reset(paths: string[]): Promise<Confirmed>;
  /** What to tell the user of a call that failed, beside this parameter. */
  textOf(error: unknown, path: string): string;
}

/**
 * The parameters of a sequence: what the server has confirmed, and what is wanted of it. While the
 * user drags, each call carries the newest value and the next begins when it is answered, so the
 * sequence follows as quickly as it can and never lags behind.
 */
export class ParameterEditor {
  readonly changed = new Signal();
  private fields: ReadonlyMap<string, Field> = new Map();
  private order: readonly string[] = [];
  private readonly wanted = new Map<string, Plain>();
  private sending = false;
  // Counts what was sent and answered: a list that was asked for before may be out of date.
  private changes = 0;

  constructor(private readonly calls: ParameterCalls) {}

  /** In the server's order; the same array until parameters come or go. */
  readonly paths = (): readonly string[] => this.order;

  field(path: string): Field | undefined {
    return this.fields.get(path);
  }

  /** Asks the server for all; what others have changed appears. */
  async load(): Promise<void> {
    const before = this.changes;
    const parameters = await this.calls.list();
    if (this.changes !== before || this.sending) return;
    const fields = new Map<string, Field>();
    for (const { path, info, value } of parameters) {
      const plain = plainOf(value);
      if (!info || plain === undefined) continue;
      const known = this.fields.get(path);
      const same = known && known.value === plain && equals(ParameterInfoSchema, known.info, info);
      const fresh = { path, info, value: plain, draft: undefined, error: '' };
      fields.set(
        path,
        same ? known : { ...fresh, draft: known?.draft, appliedAtFrame: undefined },
      );
    }
    this.fields = fields;
    const order = [...fields.keys()];
    if (order.join() !== this.order.join()) this.order = order;
    this.changed.emit();
  }

  /** Wants another value. Acts with the next frame. */
  edit(path: string, value: Plain): void {
    const field = this.fields.get(path);
    if (!field || (field.draft ?? field.value) === value) return;
    this.wanted.set(path, value);
    this.put(path, { draft: value, error: '' });
    if (!this.sending) void this.send();
  }

  /** Sets parameters back to their initial values. */
  async reset(paths: string[]): Promise<void> {
    for (const path of paths) {
      this.wanted.delete(path);
      this.put(path, { draft: plainOf(this.fields.get(path)?.info.initial), error: '' });
    }
    ++this.changes;
    try {
      this.confirm(await this.calls.reset(paths));
    } catch (error) {
      for (const path of paths) this.refuse(path, error);
    }
    ++this.changes;
  }

  private async send(): Promise<void> {
    this.sending = true;
    for (;;) {
      const [next] = this.wanted;
      if (!next) break;
      const [path, value] = next;
      this.wanted.delete(path);
      const field = this.fields.get(path);
      if (!field) continue;
      ++this.changes;
      try {
        this.confirm(await this.calls.set(path, field.info, value));
      } catch (error) {
        this.refuse(path, error);
      }
    }
    this.sending = false;
  }

  private confirm({ appliedAtFrame, values }: Confirmed): void {
    for (const { path, value } of values) {
      const plain = plainOf(value);
      if (plain === undefined) continue;
      this.put(path, {
        value: plain,
        draft: this.wanted.get(path),
        error: '',
        appliedAtFrame: appliedAtFrame > 0n ? appliedAtFrame : undefined,
      });
    }
  }

  /** Snaps back to what the server has, unless something newer is wanted already. */
  private refuse(path: string, error: unknown): void {
    const draft = this.wanted.get(path);
    this.put(path, { draft, error: draft === undefined ? this.calls.textOf(error, path) : '' });
  }

  private put(path: string, change: Partial<Field>): void {
    const field = this.fields.get(path);
    if (!field) return;
    this.fields = new Map(this.fields).set(path, { ...field, ...change });
    this.changed.emit();
  }
}
