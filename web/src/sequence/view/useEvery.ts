import { useEffect, useRef, useState } from 'react';

/** What `read` gives, asked again every `period_ms`; renders only when it differs (as JSON). */
export function useEvery<T>(period_ms: number, read: () => T): T {
  const [value, setValue] = useState(read);
  const latest = useRef(read);
  useEffect(() => {
    latest.current = read;
  });
  useEffect(() => {
    const look = () => {
      const next = latest.current();
      setValue((now) => (JSON.stringify(now) === JSON.stringify(next) ? now : next));
    };
    look();
    const timer = setInterval(look, period_ms);
    return () => clearInterval(timer);
  }, [period_ms]);
  return value;
}
