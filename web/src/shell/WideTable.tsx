import { Table, VisuallyHidden } from '@mantine/core';
import type { ReactNode } from 'react';

/** A table that scrolls sideways by itself, also by keyboard, where the window is too narrow. */
export function WideTable({ label, children }: { label: string; children: ReactNode }) {
  return (
    <Table.ScrollContainer
      type="native"
      minWidth={720}
      tabIndex={0}
      role="region"
      aria-label={label}
    >
      <Table className="vs-table" verticalSpacing="xs" horizontalSpacing="xs">
        {children}
      </Table>
    </Table.ScrollContainer>
  );
}

/** Heading of a column that needs none for those who see it, such as one of buttons. */
export function HiddenTh({ children }: { children: string }) {
  return (
    <Table.Th>
      <VisuallyHidden>{children}</VisuallyHidden>
    </Table.Th>
  );
}
