import '../i18n';
import { render } from '@testing-library/react';
import { createMemoryRouter } from 'react-router';
import { routes } from '../routes';
import { App } from '../shell/App';

/** Opens the whole page at an address, as the browser would. */
export function renderPage(address: string) {
  const router = createMemoryRouter(routes, { initialEntries: [address] });
  render(<App router={router} env="test" />);
  return { path: () => router.state.location.pathname };
}
