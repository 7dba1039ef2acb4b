import { type InputHTMLAttributes, useState } from 'react';
import classes from './form.module.css';

interface Props extends Omit<InputHTMLAttributes<HTMLInputElement>, 'value' | 'accept'> {
  value: string;
  /** False when the text cannot be used; it then stays to be mended. */
  accept: (text: string) => boolean;
  /** Arrow keys, +1 up, -1 down, from what is `typed` where that is not complete; false: see accept. */
  onStep?: (direction: number, typed: string | undefined) => boolean;
}

/**
 * A text that counts once it is complete: by Enter, by leaving it, or by a step. It follows `value`
 * unless it is being typed; Escape gives up what is typed.
 */
export function TypedText({ value, accept, onStep, className, ...rest }: Props) {
  const [typed, setTyped] = useState<string>();
  const [faulty, setFaulty] = useState(false);
  const finish = () => {
    if (typed === undefined) return;
    const good = typed === value || accept(typed);
    setFaulty(!good);
    if (good) setTyped(undefined);
  };
  const giveUp = () => {
    setTyped(undefined);
    setFaulty(false);
  };
  return (
    <input
      {...rest}
      type="text"
      className={`${classes.input} ${className ?? ''}`}
      value={typed ?? value}
      aria-invalid={faulty}
      autoComplete="off"
      spellCheck={false}
      onChange={(event) => setTyped(event.currentTarget.value)}
      onBlur={finish}
      onKeyDown={(event) => {
        const steps: Record<string, number> = { ArrowUp: 1, ArrowDown: -1 };
        const direction = steps[event.key];
        if (event.key === 'Enter') finish();
        if (event.key === 'Escape') giveUp();
        if (direction !== undefined && onStep) {
          event.preventDefault();
          if (onStep(direction, typed)) giveUp();
        }
      }}
    />
  );
}
