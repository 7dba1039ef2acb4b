/** Texts of the frame around the pages. */
export const en = {
  overview: 'Overview',
  results: 'Results',
  users: 'Users',
  audit: 'Audit',
};

export const de: typeof en = {
  overview: 'Übersicht',
  results: 'Ergebnisse',
  users: 'Benutzer',
  audit: 'Protokoll',
};
