import { createTheme, type CSSVariablesResolver, Input, Menu } from '@mantine/core';

/** Small radii, the cyan of the sign, bluish greys, and focus rings that are always visible. */
export const theme = createTheme({
  primaryColor: 'cyan',
  primaryShade: 9, // white text on it has 5.4 : 1
  colors: {
    dark: [
      '#dfe3e8',
      '#b3bac3',
      '#98a1ac',
      '#6a737f',
      '#4a525c',
      '#333a42',
      '#262b31',
      '#16191d',
      '#111417',
      '#0b0d0f',
    ],
  },
  autoContrast: true,
  defaultRadius: 'sm',
  focusRing: 'auto',
  cursorType: 'pointer',
  fontFamily: 'Inter, system-ui, "Segoe UI", Roboto, "Noto Sans", sans-serif',
  fontFamilyMonospace: 'ui-monospace, "JetBrains Mono", "DejaVu Sans Mono", monospace',
  components: {
    // Nearly all fields are required; those that are not say so.
    InputWrapper: Input.Wrapper.extend({ defaultProps: { withAsterisk: false } }),
    // The first item gets the focus, not an element without a role that screen readers stumble over.
    Menu: Menu.extend({ defaultProps: { withInitialFocusPlaceholder: false } }),
  },
  headings: { sizes: { h1: { fontSize: '1.25rem' }, h2: { fontSize: '1rem' } } },
});

// Mantine's own secondary text has less than 4.5 : 1 (WCAG AA) on light grounds.
export const cssVariables: CSSVariablesResolver = () => ({
  variables: {},
  light: {
    '--mantine-primary-color-filled-hover': '#095c6b', // Mantine's is lighter: 4.3 : 1
    '--mantine-color-cyan-filled-hover': '#095c6b',
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
    '--mantine-primary-color-filled-hover': '#095c6b',
    '--mantine-color-cyan-filled-hover': '#095c6b',
    '--mantine-color-dimmed': 'var(--mantine-color-dark-1)',
    '--mantine-color-placeholder': 'var(--mantine-color-dark-1)',
    '--mantine-color-error': 'var(--mantine-color-red-4)',
    '--vs-panel': '#1d2126',
    '--vs-good': '#38d9a9',
    '--vs-warning': '#ffc078',
    '--vs-bad': '#ff8787',
  },
});
