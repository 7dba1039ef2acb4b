/** Texts of the pages for administrators. */
export const en = {
  users: 'Users',
  audit: 'Audit',
};

export const de: typeof en = {
  users: 'Benutzer',
  audit: 'Protokoll',
};
