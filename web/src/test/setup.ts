import { cleanup, configure } from '@testing-library/react';
import { afterEach, vi } from 'vitest';

// Tests of what needs no page say `@vitest-environment node` in their first line, and start quicker.
if (typeof window !== 'undefined') {
  // What jsdom lacks and Mantine asks for.
  vi.stubGlobal('ResizeObserver', class {
    observe() {}
    unobserve() {}
    disconnect() {}
  });
  Object.defineProperty(window, 'matchMedia', {
    value: (query: string) => ({
      matches: false,
      media: query,
      addEventListener: () => {},
      removeEventListener: () => {},
      addListener: () => {},
      removeListener: () => {},
    }),
  });
  Element.prototype.scrollIntoView = () => {};

  const [{ addTexts }, { texts }] = await Promise.all([
    import('../i18n'),
    import('../i18n/texts'),
  ]);
  for (const [folder, text] of Object.entries(texts)) {
    addTexts(folder as keyof typeof texts, text as (typeof texts)['shell']);
  }
}

// A busy machine is no fault of the page.
configure({ asyncUtilTimeout: 30_000 });

afterEach(cleanup);
