import '../../i18n';
import { create } from '@bufbuild/protobuf';
import { Code, ConnectError } from '@connectrpc/connect';
import { MantineProvider } from '@mantine/core';
import { fireEvent, render, screen, within } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { useState } from 'react';
import { beforeEach, describe, expect, it, vi } from 'vitest';
import { ParameterService } from '../../gen/visionserver/v1/parameter_pb';
import { ParameterType, SequenceSpecSchema } from '../../gen/visionserver/v1/sequence_pb';
import { Role } from '../../gen/visionserver/v1/session_pb';
import { setLanguage } from '../../i18n';
import { freshTab, logIn, serve } from '../../test/fakeServer';
import ParameterForm from './ParameterForm';
import { plainOf, valueOf } from './value';

vi.mock('@connectrpc/connect-web', async () => (await import('../../test/fakeServer')).connectWeb);

const infos = [
  { path: 'match.p2', name: 'p2', type: ParameterType.INT, min: 0, max: 64, unit: 'px', initial: 35 },
  { path: 'match.fill', name: 'fill', type: ParameterType.BOOL, initial: true, operatorEditable: true },
  {
    path: 'match.preset',
    name: 'preset',
    type: ParameterType.CHOICE,
    choices: ['quality', 'strict'],
    initial: 'quality',
    fixedWhileRunning: true,
  },
  { path: 'match.scale', name: 'scale', type: ParameterType.DOUBLE, initial: 0.5 },
  { path: 'cameras.left', name: 'left', type: ParameterType.STRING, initial: 'sim' },
];
const spec = create(SequenceSpecSchema, {
  blocks: [
    { id: 'cameras', type: 'StereoCamera' },
    { id: 'match', type: 'SgmStereo' },
  ],
});
let stored: Record<string, boolean | number | string>;
let sets: string[];
// What the server's answers wait for.
let answering: Promise<void>;

const refused = 'strict';
const infoOf = (path: string) => infos.find((info) => info.path === path)!;
const valueIn = (path: string) => valueOf(infoOf(path).type, stored[path]!);

beforeEach(async () => {
  freshTab();
  await setLanguage('en');
  stored = Object.fromEntries(infos.map(({ path, initial }) => [path, initial]));
  sets = [];
  answering = Promise.resolve();
  serve(({ service }) => {
    service(ParameterService, {
      listParameters: () => ({
        parameters: infos.map(({ path, initial, ...info }) => ({
          path,
          value: valueIn(path),
          info: { ...info, initial: valueOf(info.type, initial) },
        })),
      }),
      setParameters: async ({ values: [one] }) => {
        const value = plainOf(one?.value)!;
        sets.push(`${one!.path} = ${String(value)}`);
        await answering;
        if (value === refused) throw new ConnectError(`${one!.path}: not now`, Code.FailedPrecondition);
        if (Number(value) > 64) {
          throw new ConnectError(`${one!.path}: p2 must be 0 to 64`, Code.InvalidArgument);
        }
        stored[one!.path] = value;
        return { appliedAtFrame: 41n, values: [{ path: one!.path, value: valueIn(one!.path) }] };
      },
      resetParameters: async ({ paths }) => {
        await answering;
        for (const path of paths) stored[path] = infoOf(path).initial;
        return { appliedAtFrame: 50n, values: paths.map((path) => ({ path, value: valueIn(path) })) };
      },
    });
  });
});

function Form({ running }: { running: boolean }) {
  const [filter, setFilter] = useState('');
  return (
    <MantineProvider env="test">
      <ParameterForm
        sequence="cell"
        spec={spec}
        blockTypes={[]}
        running={running}
        filter={filter}
        setFilter={setFilter}
      />
    </MantineProvider>
  );
}

async function open(role: Role, running = true) {
  logIn('otto', role);
  render(<Form running={running} />);
  await screen.findByTestId('parameter-match.p2');
}

const field = (path: string) => within(screen.getByTestId(`parameter-${path}`));
const controls = 'input, select, textarea, button';
// A busy machine is no fault of the form.
const kPatience = { timeout: 30_000 };
const disabled = (control: HTMLElement) => control.matches(':disabled');

describe('ParameterForm', () => {
  it('sets what a slider says, and shows the frame from which it acts', async () => {
    await open(Role.ENGINEER);
    fireEvent.change(field('match.p2').getByRole('slider'), { target: { value: '40' } });
    expect(await field('match.p2').findByText('from frame 41')).toBeTruthy();
    expect(sets).toEqual(['match.p2 = 40']);
    expect(field('match.p2').getByRole<HTMLInputElement>('textbox').value).toBe('40');
    expect(field('match.p2').getByText('0 … 64 px')).toBeTruthy();
  });

  it('takes a typed number by Enter, and gives the words of a refusal', async () => {
    await open(Role.ENGINEER);
    const box = field('match.p2').getByRole<HTMLInputElement>('textbox');
    await userEvent.clear(box);
    await userEvent.type(box, '99{Enter}');
    expect((await field('match.p2').findByRole('alert')).textContent).toBe('p2 must be 0 to 64');
    expect(box.value).toBe('35');
  });

  it('takes a step from what is typed, and gives it up by Escape', async () => {
    await open(Role.ENGINEER);
    const box = field('match.p2').getByRole<HTMLInputElement>('textbox');
    await userEvent.clear(box);
    await userEvent.type(box, '50{Escape}');
    expect(box.value).toBe('35');
    await userEvent.clear(box);
    await userEvent.type(box, '50{ArrowUp}');
    await vi.waitFor(() => expect(box.value).toBe('51'));
    expect(sets).toEqual(['match.p2 = 51']);
  });

  it('shows a number that somebody else sets, but not while one is typed', async () => {
    await open(Role.ENGINEER);
    const box = field('match.p2').getByRole<HTMLInputElement>('textbox');
    stored['match.p2'] = 20;
    await vi.waitFor(() => expect(box.value).toBe('20'), kPatience);
    await userEvent.clear(box);
    await userEvent.type(box, '4');
    stored['match.p2'] = 21;
    stored['match.fill'] = false;
    const fill = field('match.fill').getByRole<HTMLInputElement>('switch');
    await vi.waitFor(() => expect(fill.checked).toBe(false), kPatience);
    expect(box.value).toBe('4');
    await userEvent.tab();
    await vi.waitFor(() => expect(sets).toEqual(['match.p2 = 4']));
  });

  it('leaves a text that is no number to be mended', async () => {
    await open(Role.ENGINEER);
    const box = field('match.p2').getByRole<HTMLInputElement>('textbox');
    await userEvent.clear(box);
    await userEvent.type(box, '4x{Enter}');
    expect(box.getAttribute('aria-invalid')).toBe('true');
    expect(box.value).toBe('4x');
    expect(sets).toEqual([]);
  });

  it('resets a parameter that differs from its initial value', async () => {
    await open(Role.ENGINEER);
    expect(field('match.fill').queryByRole('button')).toBeNull();
    await userEvent.click(field('match.fill').getByRole('switch'));
    await userEvent.click(await field('match.fill').findByRole('button', { name: 'Reset fill' }));
    expect(await field('match.fill').findByText('from frame 50')).toBeTruthy();
    expect(field('match.fill').getByRole<HTMLInputElement>('switch').checked).toBe(true);
  });

  it('shows a viewer the values as text, and no control', async () => {
    await open(Role.VIEWER, false);
    expect(
      screen.getAllByTestId(/^parameter-/).flatMap((one) => [...one.querySelectorAll(controls)]),
    ).toEqual([]);
    expect(screen.queryByRole('button')).toBeNull();
    expect(screen.getAllByTestId('value').map((one) => one.textContent)).toEqual([
      'sim',
      '35 px',
      'on',
      'quality',
      '0.5',
    ]);
    expect(field('match.p2').getByText('0 … 64 px')).toBeTruthy();
  });

  it('says values as they are said in German', async () => {
    await setLanguage('de');
    await open(Role.VIEWER);
    expect(field('match.scale').getByText('0,5')).toBeTruthy();
    expect(field('match.fill').getByText('an')).toBeTruthy();
  });

  it('gives an operator the controls that are meant for operators, and no others', async () => {
    await open(Role.OPERATOR);
    expect(disabled(field('match.fill').getByRole('switch'))).toBe(false);
    expect(screen.getByTestId('parameter-match.p2').querySelector(controls)).toBeNull();
    expect(field('match.p2').getByText('35 px')).toBeTruthy();
    expect(field('match.p2').getByText(/for engineers/)).toBeTruthy();
  });

  describe('while the server has not answered', () => {
    let answer: () => void;
    beforeEach(() => {
      answering = new Promise((done) => (answer = done));
    });
    const pending = (path: string) => field(path).queryByTestId('pending')?.textContent;

    it('shows of a switch what is confirmed, and that another value is on its way', async () => {
      await open(Role.ENGINEER);
      const fill = field('match.fill').getByRole<HTMLInputElement>('switch');
      await userEvent.click(fill);
      expect(fill.checked).toBe(true);
      expect(pending('match.fill')).toBe('setting off …');
      answer();
      await vi.waitFor(() => expect(fill.checked).toBe(false), kPatience);
      expect(pending('match.fill')).toBeUndefined();
    });

    it('shows of a choice what is confirmed, and keeps it with the reason of a refusal', async () => {
      await open(Role.ENGINEER, false);
      const preset = field('match.preset').getByRole<HTMLSelectElement>('combobox');
      await userEvent.selectOptions(preset, refused);
      expect(preset.value).toBe('quality');
      expect(pending('match.preset')).toBe('setting strict …');
      answer();
      expect((await field('match.preset').findByRole('alert')).textContent).toBe('not now');
      expect(preset.value).toBe('quality');
      expect(pending('match.preset')).toBeUndefined();
    });

    it('shows of numbers and texts what is confirmed, also when they are reset', async () => {
      stored['match.p2'] = 20;
      await open(Role.ENGINEER);
      const left = field('cameras.left').getByRole<HTMLInputElement>('textbox');
      await userEvent.type(left, '2{Enter}');
      await userEvent.click(field('match.p2').getByRole('button', { name: 'Reset p2' }));
      const box = field('match.p2').getByRole<HTMLInputElement>('textbox');
      expect([left.value, box.value]).toEqual(['sim', '20']);
      expect(pending('cameras.left')).toBe('setting sim2 …');
      expect(pending('match.p2')).toBe('setting 35 px …');
      answer();
      await vi.waitFor(() => expect([left.value, box.value]).toEqual(['sim2', '35']), kPatience);
      expect([pending('cameras.left'), pending('match.p2')]).toEqual([undefined, undefined]);
    });
  });

  it('keeps what is fixed while running until the sequence is stopped', async () => {
    await open(Role.ENGINEER);
    expect(disabled(field('match.preset').getByRole('combobox'))).toBe(true);
    expect(field('match.preset').getByText('only while the sequence is stopped')).toBeTruthy();
  });

  it('finds parameters by name and by block', async () => {
    await open(Role.ENGINEER);
    const search = screen.getByRole('searchbox');
    await userEvent.type(search, 'p2');
    expect(screen.queryByTestId('parameter-cameras.left')).toBeNull();
    await userEvent.clear(search);
    await userEvent.type(search, 'stereocamera');
    expect(screen.getByTestId('parameter-cameras.left')).toBeTruthy();
    expect(screen.queryByTestId('parameter-match.p2')).toBeNull();
    await userEvent.clear(search);
    await userEvent.type(search, 'xyz');
    expect(screen.getByText(/No parameter has “xyz”/)).toBeTruthy();
  });
});
