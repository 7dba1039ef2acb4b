import '../i18n';
import { render } from '@testing-library/react';
import { MemoryRouter, useLocation } from 'react-router';
import { Pages } from '../routes';
import { App } from '../shell/App';

/** Opens the whole page at an address, as the browser would. */
export function renderPage(address: string) {
  let path = '';
  function Probe() {
    path = useLocation().pathname;
    return null;
  }
  render(
    <App env="test">
      <MemoryRouter initialEntries={[address]}>
        <Pages />
        <Probe />
      </MemoryRouter>
    </App>,
  );
  return { path: () => path };
}
