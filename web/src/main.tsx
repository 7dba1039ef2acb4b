import './shell/mantineStyles';
import './shell/shell.css';
import './i18n';
import { StrictMode } from 'react';
import { createRoot } from 'react-dom/client';
import { BrowserRouter } from 'react-router';
import { Pages } from './routes';
import { App } from './shell/App';

const root = document.getElementById('root');
if (root) {
  createRoot(root).render(
    <StrictMode>
      <App>
        <BrowserRouter>
          <Pages />
        </BrowserRouter>
      </App>
    </StrictMode>,
  );
}
