import { type ComponentType, lazy, type ReactNode } from 'react';
import { Navigate, Route, Routes } from 'react-router';
import { isAdmin, useRole } from './api/session';
import { addTexts } from './i18n';
import type { texts } from './i18n/texts';
import { Layout } from './shell/Layout';
import { LoginPage } from './shell/LoginPage';
import { NoSuchPage } from './shell/PageErrors';

type Texts = typeof texts;

/** A page with the texts of its folder, both loaded when it is first opened. */
function page<Folder extends keyof Texts>(
  folder: Folder,
  loadTexts: () => Promise<Texts[Folder]>,
  loadPage: () => Promise<{ default: ComponentType }>,
) {
  return lazy(async () => {
    const [pageTexts, module] = await Promise.all([loadTexts(), loadPage()]);
    addTexts(folder, pageTexts);
    return module;
  });
}

const adminTexts = () => import('./admin/text');
const OverviewPage = page(
  'overview',
  () => import('./overview/text'),
  () => import('./overview/OverviewPage'),
);
const SequencePage = page(
  'sequence',
  () => import('./sequence/text'),
  () => import('./sequence/SequencePage'),
);
const ResultsPage = page(
  'results',
  () => import('./results/text'),
  () => import('./results/ResultsPage'),
);
const UsersPage = page('admin', adminTexts, () => import('./admin/UsersPage'));
const AuditPage = page('admin', adminTexts, () => import('./admin/AuditPage'));

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
