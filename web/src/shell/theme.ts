import { createTheme, type CSSVariablesResolver } from '@mantine/core';

/** Small radii, a teal that carries white text, and focus rings that are always visible. */
export const theme = createTheme({
  primaryColor: 'teal',
  primaryShade: { light: 9, dark: 7 },
  autoContrast: true,
  defaultRadius: 'sm',
  focusRing: 'auto',
  cursorType: 'pointer',
  fontFamily: 'Inter, system-ui, "Segoe UI", Roboto, "Noto Sans", sans-serif',
  fontFamilyMonospace: 'ui-monospace, "JetBrains Mono", "DejaVu Sans Mono", monospace',
  headings: { sizes: { h1: { fontSize: '1.25rem' }, h2: { fontSize: '1rem' } } },
});

// Mantine's own secondary text has less than 4.5 : 1 (WCAG AA) on light grounds.
export const cssVariables: CSSVariablesResolver = () => ({
  variables: {},
  light: {
    '--mantine-color-dimmed': 'var(--mantine-color-gray-7)',
    '--mantine-color-placeholder': 'var(--mantine-color-gray-7)',
    '--mantine-color-error': 'var(--mantine-color-red-9)',
    '--mantine-color-body': '#fbfcfd',
    '--vs-panel': '#ffffff',
    '--vs-good': '#087f5b',
    '--vs-warning': '#a85a00',
    '--vs-bad': '#c92a2a',
  },
  dark: {
    '--mantine-color-dimmed': 'var(--mantine-color-dark-1)',
    '--mantine-color-placeholder': 'var(--mantine-color-dark-1)',
    '--mantine-color-error': 'var(--mantine-color-red-4)',
    '--mantine-color-body': '#16191d',
    '--vs-panel': '#1e2227',
    '--vs-good': '#38d9a9',
    '--vs-warning': '#ffc078',
    '--vs-bad': '#ff8787',
  },
});
