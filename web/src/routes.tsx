import { lazy, type ReactNode } from 'react';
import { Navigate } from 'react-router';
import { isAdmin, useRole } from './api/session';
import { Layout } from './shell/Layout';
import { LoginPage } from './shell/LoginPage';
import { NoSuchPage, PageError } from './shell/PageErrors';

const OverviewPage = lazy(() => import('./overview/OverviewPage'));
const SequencePage = lazy(() => import('./sequence/SequencePage'));
const ResultsPage = lazy(() => import('./results/ResultsPage'));
const UsersPage = lazy(() => import('./admin/UsersPage'));
const AuditPage = lazy(() => import('./admin/AuditPage'));

function AdminsOnly({ children }: { children: ReactNode }) {
  return isAdmin(useRole()) ? children : <Navigate to="/" replace />;
}

/** Every page there is; each is loaded when it is first opened. */
export const routes = [
  { path: '/login', element: <LoginPage />, errorElement: <PageError /> },
  {
    element: <Layout />,
    errorElement: <PageError />,
    children: [
      {
        errorElement: <PageError />,
        children: [
          { index: true, element: <OverviewPage /> },
          { path: 'sequence/:id', element: <SequencePage /> },
          { path: 'results', element: <ResultsPage /> },
          {
            path: 'users',
            element: (
              <AdminsOnly>
                <UsersPage />
              </AdminsOnly>
            ),
          },
          {
            path: 'audit',
            element: (
              <AdminsOnly>
                <AuditPage />
              </AdminsOnly>
            ),
          },
          { path: '*', element: <NoSuchPage /> },
        ],
      },
    ],
  },
];
