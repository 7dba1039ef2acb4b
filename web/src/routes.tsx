import { lazy } from 'react';
import { createBrowserRouter } from 'react-router';
import { Layout } from './shell/Layout';

const OverviewPage = lazy(() => import('./overview/OverviewPage'));
const SequencePage = lazy(() => import('./sequence/SequencePage'));
const ResultsPage = lazy(() => import('./results/ResultsPage'));
const UsersPage = lazy(() => import('./admin/UsersPage'));
const AuditPage = lazy(() => import('./admin/AuditPage'));

/** Every page there is; each is loaded when it is first opened. */
export const router = createBrowserRouter([
  {
    element: <Layout />,
    children: [
      { index: true, element: <OverviewPage /> },
      { path: 'sequence/:id', element: <SequencePage /> },
      { path: 'results', element: <ResultsPage /> },
      { path: 'users', element: <UsersPage /> },
      { path: 'audit', element: <AuditPage /> },
    ],
  },
]);
