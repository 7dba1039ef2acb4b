import { MantineProvider } from '@mantine/core';
import { fireEvent, render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { type ReactNode, useState } from 'react';
import { describe, expect, it } from 'vitest';

import { InstantInput, WordInput } from './SelectionInputs';

/** A field, and a button that changes what is chosen from elsewhere. */
function Host<T>(props: { first: T; other: T; field: (value: T, set: (value: T) => void) => ReactNode }) {
  const [value, setValue] = useState(props.first);
  return (
    <MantineProvider env="test">
      {props.field(value, setValue)}
      <button onClick={() => setValue(props.other)}>other</button>
    </MantineProvider>
  );
}

const localMs = (text: string) => new Date(text).getTime();

function openInstant() {
  const chosen: (number | undefined)[] = [];
  render(
    <Host<number | undefined>
      first={localMs('2026-11-22T18:31:05')}
      other={localMs('2026-11-20T08:00:09')}
      field={(ms, set) => (
        <InstantInput
          label="From"
          ms={ms}
          onChange={(next) => {
            chosen.push(next);
            set(next);
          }}
        />
      )}
    />,
  );
  const box = screen.getByLabelText<HTMLInputElement>('From');
  const type = (value: string) => fireEvent.change(box, { target: { value } });
  return { box, chosen, type };
}

describe('an instant', () => {
  it('takes effect with Enter and when it is left, once and only when it has changed', () => {
    const { box, chosen, type } = openInstant();
    type('2026-11-22T19:00:01');
    expect(chosen).toEqual([]);
    fireEvent.keyDown(box, { key: 'Enter' });
    expect(chosen).toEqual([localMs('2026-11-22T19:00:01')]);
    fireEvent.blur(box);
    expect(chosen).toHaveLength(1);
    type('2026-11-22T20:00:01');
    fireEvent.blur(box);
    expect(chosen.slice(1)).toEqual([localMs('2026-11-22T20:00:01')]);
    type('');
    fireEvent.blur(box);
    expect(chosen.slice(2)).toEqual([undefined]);
  });

  it('takes effect with each step', () => {
    const { box, chosen, type } = openInstant();
    fireEvent.keyDown(box, { key: 'ArrowUp' });
    type('2026-11-22T18:31:06');
    expect(chosen).toEqual([localMs('2026-11-22T18:31:06')]);
  });

  it('is given up by Escape', () => {
    const { box, chosen, type } = openInstant();
    type('2026-11-22T19:00:01');
    fireEvent.keyDown(box, { key: 'Escape' });
    expect(localMs(box.value)).toBe(localMs('2026-11-22T18:31:05'));
    fireEvent.blur(box);
    expect(chosen).toEqual([]);
  });

  it('follows what is chosen elsewhere, unless it is being edited', () => {
    const { box, type } = openInstant();
    type('2026-11-22T19:00:01');
    fireEvent.click(screen.getByText('other'));
    expect(localMs(box.value)).toBe(localMs('2026-11-22T19:00:01'));
    fireEvent.keyDown(box, { key: 'Escape' });
    expect(localMs(box.value)).toBe(localMs('2026-11-20T08:00:09'));
  });
});

it('a word is given up by Escape and follows what is chosen elsewhere', async () => {
  const chosen: string[] = [];
  const field = (value: string, set: (value: string) => void) => (
    <WordInput
      label="Part"
      value={value}
      onChange={(next) => {
        chosen.push(next);
        set(next);
      }}
    />
  );
  render(<Host first="a" other="z" field={field} />);
  const box = screen.getByRole<HTMLInputElement>('combobox', { name: 'Part' });
  await userEvent.type(box, 'b{Escape}');
  expect(box.value).toBe('a');
  await userEvent.type(box, 'c{Enter}');
  expect(chosen).toEqual(['ac']);
  await userEvent.click(screen.getByText('other'));
  expect(box.value).toBe('z');
  expect(chosen).toEqual(['ac']);
});
