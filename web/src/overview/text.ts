/** Texts of the overview page. */
export const en = {
  title: 'Overview',
};

export const de: typeof en = {
  title: 'Übersicht',
};
