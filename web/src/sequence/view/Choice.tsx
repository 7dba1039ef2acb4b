import classes from './view.module.css';

interface Props<T extends string> {
  label: string;
  value: T;
  /** Value and text of each. */
  choices: (readonly [T, string])[];
  onChoose: (value: T) => void;
}

/** One of a few. The browser's own control: light, and every keyboard knows it. */
export function Choice<T extends string>({ label, value, choices, onChoose }: Props<T>) {
  return (
    <select
      className={classes.choice}
      aria-label={label}
      title={label}
      value={value}
      onChange={(event) => {
        const chosen = choices.find(([one]) => one === event.currentTarget.value);
        if (chosen) onChoose(chosen[0]);
      }}
    >
      {choices.map(([one, text]) => (
        <option key={one} value={one}>
          {text}
        </option>
      ))}
    </select>
  );
}
