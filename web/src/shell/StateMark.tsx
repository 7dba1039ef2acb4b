import { Group, Text } from '@mantine/core';

export type Level = 'good' | 'busy' | 'warning' | 'bad' | 'off';

const colours: Record<Level, string> = {
  good: 'var(--vs-good)',
  busy: 'var(--vs-warning)',
  warning: 'var(--vs-warning)',
  bad: 'var(--vs-bad)',
  off: 'var(--mantine-color-dimmed)',
};

/** A state in a word, with a mark whose shape says the same as its colour. */
export function StateMark({ level, label }: { level: Level; label: string }) {
  const colour = colours[level];
  return (
    <Group gap={6} wrap="nowrap" c={colour}>
      <svg viewBox="0 0 10 10" width="10" height="10" style={{ flex: 'none' }} aria-hidden="true">
        {level === 'good' && <circle cx="5" cy="5" r="4.5" fill={colour} />}
        {level === 'off' && (
          <circle cx="5" cy="5" r="3.5" fill="none" stroke={colour} strokeWidth="1.5" />
        )}
        {level === 'bad' && <rect width="10" height="10" fill={colour} />}
        {(level === 'warning' || level === 'busy') && <path d="M5 0 10 9.5H0z" fill={colour} />}
      </svg>
      <Text span size="sm" fw={500}>
        {label}
      </Text>
    </Group>
  );
}
