import classes from './view.module.css';

interface Props<T extends string> {
  label: string;
  /** What the value means, where its text is too short for that. */
  help?: string;
  value: T;
  /** Value and text of each. */
  choices: (readonly [T, string])[];
  onChoose: (value: T) => void;
}

/** One of a few. The browser's own control: light, and every keyboard knows it. */
export function Choice<T extends string>({ label, help, value, choices, onChoose }: Props<T>) {
  return (
    <select
      className={classes.choice}
      aria-label={label}
      title={help ?? label}
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
