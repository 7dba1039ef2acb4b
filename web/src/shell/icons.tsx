import type { ReactNode } from 'react';

// Own line drawings of 16 x 16: a dozen of them does not need a library.
function icon(drawing: ReactNode) {
  return function Icon() {
    return (
      <svg
        viewBox="0 0 16 16"
        width="16"
        height="16"
        fill="none"
        stroke="currentColor"
        strokeWidth="1.5"
        strokeLinecap="round"
        strokeLinejoin="round"
        aria-hidden="true"
      >
        {drawing}
      </svg>
    );
  };
}

export const PlayIcon = icon(<path d="M4.5 2.5v11l9-5.5z" />);
export const StopIcon = icon(<rect x="3.5" y="3.5" width="9" height="9" rx="1" />);
export const UserIcon = icon(
  <>
    <circle cx="8" cy="5" r="2.8" />
    <path d="M2.5 14c.6-3 2.6-4.5 5.5-4.5s4.9 1.5 5.5 4.5" />
  </>,
);
export const SunIcon = icon(
  <>
    <circle cx="8" cy="8" r="3" />
    <path d="M8 1v1.5M8 13.5V15M1 8h1.5M13.5 8H15M3 3l1 1M12 12l1 1M13 3l-1 1M4 12l-1 1" />
  </>,
);
export const MoonIcon = icon(<path d="M13.5 9.5A6 6 0 0 1 6.5 2.5a6 6 0 1 0 7 7z" />);
export const AlertIcon = icon(
  <>
    <path d="M8 1.8 15 14H1z" />
    <path d="M8 6v4M8 12v.2" />
  </>,
);
export const CheckIcon = icon(<path d="m3 8.5 3.5 3.5L13 4.5" />);
export const MoreIcon = icon(<path d="M3 8h.01M8 8h.01M13 8h.01" strokeWidth="2.5" />);
export const PlusIcon = icon(<path d="M8 3v10M3 8h10" />);

/** Two eyes: the sign of the product. */
export function Logo() {
  return (
    <svg viewBox="0 0 32 32" width="28" height="28" aria-hidden="true">
      <rect width="32" height="32" rx="7" fill="#0b7285" />
      <g fill="none" stroke="#fff" strokeWidth="2.5">
        <circle cx="10.5" cy="16" r="5.5" />
        <circle cx="21.5" cy="16" r="5.5" />
      </g>
    </svg>
  );
}
