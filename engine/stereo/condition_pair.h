#pragma once

#include "engine/image/buffer.h"
#include "engine/image/image.h"
#include "engine/stereo/sgm_settings.h"
#include "engine/stereo/thread_team.h"

namespace vs {

// What every matcher does to a pair before it compares anything; all that follows (costs, edges,
// reasons) sees only the conditioned pictures.
//
//   1. match_gain: the right picture's grey g becomes gain * g + offset, so that its greys are
//      distributed like the left one's.
//   2. pre_blur: both pictures are smoothed.
struct PicturePair {
  GreyImage left;
  GreyImage right;
};

// The same pictures, not copied, where there is nothing to do. With more than one part each picture
// has a thread of its own.
PicturePair ConditionPair(const GreyImage& left, const GreyImage& right,
                          const SgmSettings& settings, int parts, ThreadTeam* team,
                          BufferPool& pool);
PicturePair ConditionPair(const GreyImage& left, const GreyImage& right,
                          const SgmSettings& settings, BufferPool& pool);

// Standard deviation of a picture's noise, in sixteenths of a grey level.
//
// The mask (1 -2 1, -2 4 -2, 1 -2 1) answers to noise and not to surfaces and straight edges
// (Immerkaer, Fast noise variance estimation, 1996, eq. 2); the mean of its absolute value over
// blocks of 8 x 8 pixels is taken, and of the blocks the one with 5 % below it, because texture
// only adds. Blocks that touch the ends of the grey scale, where noise is cut off, do not count; 0
// if there are no others.
int NoiseSixteenths(const GreyImage& picture);

// grey' = (gain * grey + offset) / 4096, rounded, within 0..255.
struct GreyMap {
  static constexpr int kOne = 4096;
  int gain = kOne;  // kOne / 2 .. kOne * 2
  int offset = 0;

  bool operator==(const GreyMap&) const = default;
};

// What gives the right picture's greys the distribution of the left one's: the line through the
// 19 quantiles 5 %, 10 % .. 95 % of both, by least squares. Each picture is looked at without the
// columns that the other one does not show at the middle of the search range. The identity where
// the quantiles differ by less than 5 grey levels on average, which may be the scene's doing, where
// there is too little contrast to tell, and where the contrast differs by more than a factor of 2.
GreyMap MatchGreys(const GreyImage& left, const GreyImage& right, const SgmSettings& settings);

}  // namespace vs
