// Fields of the selection. What is typed takes effect with Enter, a choice, a step or when the field
// is left, not with each letter, which would ask the server; Escape gives it up. A field that is not
// being edited follows the selection, whoever changes that.
import { Autocomplete, TextInput } from '@mantine/core';
import { useRef, useState } from 'react';

import { fromLocalInput, toLocalInput } from './time';

/** What a field shows: what is typed, until what is chosen has followed; else what is chosen. */
function useTyped(chosen: string) {
  const [typed, setTyped] = useState<string>();
  const [committed, setCommitted] = useState(false);
  const [last, setLast] = useState(chosen);
  if (chosen !== last) {
    setLast(chosen);
    if (committed) setTyped(undefined);
  }
  return {
    shown: typed ?? chosen,
    type: (text: string) => {
      setTyped(text);
      setCommitted(false);
    },
    commit: () => setCommitted(true),
    giveUp: () => setTyped(undefined),
  };
}

interface WordProps {
  label: string;
  value: string;
  onChange: (value: string) => void;
  choices?: string[];
}

/** A word, perhaps one of some that are offered. */
export function WordInput({ label, value, onChange, choices = [] }: WordProps) {
  const { shown, type, commit, giveUp } = useTyped(value);
  const choose = (text: string) => {
    if (text.trim() === value) return giveUp();
    commit();
    onChange(text.trim());
  };
  return (
    <Autocomplete
      w={140}
      label={label}
      data={choices}
      value={shown}
      onChange={type}
      onOptionSubmit={choose}
      onBlur={() => choose(shown)}
      onKeyDown={(event) => {
        if (event.key === 'Enter') choose(event.currentTarget.value);
        if (event.key === 'Escape') giveUp();
      }}
    />
  );
}

interface InstantProps {
  label: string;
  /** UTC; undefined: none. */
  ms: number | undefined;
  onChange: (ms: number | undefined) => void;
}

/** An instant of local time, to the second. */
export function InstantInput({ label, ms, onChange }: InstantProps) {
  const chosen = toLocalInput(ms);
  const { shown, type, commit, giveUp } = useTyped(chosen);
  const stepping = useRef(false);
  const choose = (input: HTMLInputElement) => {
    // Half a date is no instant, and not none either: it stays to be completed.
    if (input.validity.badInput) return;
    const next = fromLocalInput(input.value);
    if (toLocalInput(next) === chosen) return giveUp();
    commit();
    onChange(next);
  };
  return (
    <TextInput
      type="datetime-local"
      step={1}
      label={label}
      title={ms === undefined ? undefined : new Date(ms).toISOString()}
      value={shown}
      onChange={(event) => {
        type(event.currentTarget.value);
        if (stepping.current && event.currentTarget.value !== '') choose(event.currentTarget);
      }}
      onBlur={(event) => choose(event.currentTarget)}
      onKeyDown={(event) => {
        stepping.current = event.key === 'ArrowUp' || event.key === 'ArrowDown';
        if (event.key === 'Enter') choose(event.currentTarget);
        if (event.key === 'Escape') {
          // Also of half a date, which is no value that React would know of.
          event.currentTarget.value = chosen;
          giveUp();
        }
      }}
    />
  );
}
