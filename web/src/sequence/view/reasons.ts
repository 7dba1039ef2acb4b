import type { InvalidReason } from '../../gen/visionserver/v1/stream_pb';

/** Names of the reasons in the texts, in the order of their numbers. */
export const reasonNames = [
  'unknown',
  'occluded',
  'lowTexture',
  'ambiguous',
  'tooNear',
  'tooFar',
  'saturated',
  'dark',
  'border',
  'speckle',
  'masked',
  'filtered',
] as const;

export type ReasonName = (typeof reasonNames)[number];

export const reasonName = (reason: InvalidReason): ReasonName => reasonNames[reason] ?? 'unknown';

// Strong, and far from each other also for the colour-blind (after Okabe and Ito, with three more).
const colors: Record<ReasonName, number> = {
  unknown: 0x000000,
  occluded: 0xe69f00,
  lowTexture: 0x56b4e9,
  ambiguous: 0xcc79a7,
  tooNear: 0xd55e00,
  tooFar: 0x0072b2,
  saturated: 0xffffff,
  dark: 0x5a3e8a,
  border: 0x7a7a7a,
  speckle: 0xf0e442,
  masked: 0x3a3a3a,
  filtered: 0x009e73,
};

export const reasonCss = (name: ReasonName) => `#${colors[name].toString(16).padStart(6, '0')}`;

/** By reason number, as a canvas holds a colour; all 256, so that no byte is without a colour. */
export const reasonColors = Uint32Array.from({ length: 256 }, (_, reason) => {
  const rgb = colors[reasonNames[reason] ?? 'unknown'];
  return ((255 << 24) | ((rgb & 0xff) << 16) | (rgb & 0xff00) | (rgb >> 16)) >>> 0;
});

/** How many pixels are invalid for each reason, most first. */
export function countReasons(reasons: Uint8Array): { name: ReasonName; share: number }[] {
  const counts = new Uint32Array(256);
  for (let i = 0; i < reasons.length; ++i) ++counts[reasons[i]!]!;
  return reasonNames
    .map((name, reason) => ({ name, share: counts[reason]! / reasons.length }))
    .filter(({ share }, reason) => reason > 0 && share > 0)
    .sort((a, b) => b.share - a.share);
}
