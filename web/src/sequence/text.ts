/** Texts of the sequence page. */
export const en = {
  title: 'Sequence',
};

export const de: typeof en = {
  title: 'Sequenz',
};
