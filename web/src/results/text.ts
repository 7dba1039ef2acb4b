/** Texts of the results page. */
export const en = {
  title: 'Results',
};

export const de: typeof en = {
  title: 'Ergebnisse',
};
