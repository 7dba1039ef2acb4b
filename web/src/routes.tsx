import { lazy, type ReactNode } from 'react';
import { Navigate, Route, Routes } from 'react-router';
import { isAdmin, useRole } from './api/session';
import { Layout } from './shell/Layout';
import { LoginPage } from './shell/LoginPage';
import { NoSuchPage } from './shell/PageErrors';

const OverviewPage = lazy(() => import('./overview/OverviewPage'));
const SequencePage = lazy(() => import('./sequence/SequencePage'));
const ResultsPage = lazy(() => import('./results/ResultsPage'));
const UsersPage = lazy(() => import('./admin/UsersPage'));
const AuditPage = lazy(() => import('./admin/AuditPage'));

function ForAdmins({ children }: { children: ReactNode }) {
  return isAdmin(useRole()) ? children : <Navigate to="/" replace />;
}

/** Every page there is; each is loaded when it is first opened. */
export function Pages() {
  const users = (
    <ForAdmins>
      <UsersPage />
    </ForAdmins>
  );
  const audit = (
    <ForAdmins>
      <AuditPage />
    </ForAdmins>
  );
  return (
    <Routes>
      <Route path="/login" element={<LoginPage />} />
      <Route element={<Layout />}>
        <Route index element={<OverviewPage />} />
        <Route path="sequence/:id" element={<SequencePage />} />
        <Route path="results" element={<ResultsPage />} />
        <Route path="users" element={users} />
        <Route path="audit" element={audit} />
        <Route path="*" element={<NoSuchPage />} />
      </Route>
    </Routes>
  );
}
