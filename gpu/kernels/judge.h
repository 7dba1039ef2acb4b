// From winners to disparities: the rules of engine/stereo/selection.h, a thread for each pixel.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/image/disparity_map.h"
#include "gpu/frame.h"
#include "gpu/kernels/simt.h"

namespace vs::gpu {

// What was found at a pixel of the left view (WinnerRow).
struct Winner {
  int index;
  int best;
  int second;
  int before;
  int after;
};

struct Judged {
  int stored = kInvalidDisparity;
  int confidence = 0;
  InvalidReason reason = InvalidReason::kNone;
};

// Where between its neighbours the winner's minimum lies, -8..8 sixteenths.
VS_DEVICE int SubPixelSixteenths(SubPixel method, const Winner& w) {
  if (method == SubPixel::kOff) return 0;
  const int divisor = method == SubPixel::kEquiangular ? Greater(w.before, w.after) - w.best
                                                       : w.before + w.after - 2 * w.best;
  if (divisor <= 0) return 0;
  // floor((2 n + divisor) / (2 divisor)), made positive for the division: n >= -8 divisor.
  return (16 * (w.before - w.after) + 17 * divisor) / (2 * divisor) - 8;
}

// What the picture shows there that explains why no disparity was found, else `otherwise`.
VS_DEVICE InvalidReason Explain(const uint8_t* grey, int width, int height, int x, int y,
                                InvalidReason otherwise) {
  const int centre = grey[y * width + x];
  if (centre >= 254) return InvalidReason::kSaturated;
  if (centre <= 3) return InvalidReason::kDark;
  int low = centre;
  int high = centre;
  for (int v = Greater(y - 2, 0); v <= Lesser(y + 2, height - 1); ++v) {
    for (int u = Greater(x - 2, 0); u <= Lesser(x + 2, width - 1); ++u) {
      const int level = grey[v * width + u];
      low = Lesser(low, level);
      high = Greater(high, level);
    }
  }
  return high - low < 8 ? InvalidReason::kLowTexture : otherwise;
}

// `right_index` is the right view's row of winners.
VS_DEVICE Judged JudgePixel(const SgmSettings& settings, const uint8_t* grey, int width, int height,
                            int x, int y, const Winner& w, const uint8_t* right_index) {
  const auto refuse = [](InvalidReason reason) { return Judged{.reason = reason}; };
  const int counterpart = x - settings.min_disparity - w.index;
  if (counterpart < 0 || counterpart >= width) return refuse(InvalidReason::kBorder);

  const int last = settings.num_disparities - 1;
  const int offset_px = settings.min_disparity < 0 ? settings.min_disparity - 1 : 0;
  int stored = kDisparityScale * (settings.min_disparity + w.index - offset_px);
  if (w.index > 0 && w.index < last) stored += SubPixelSixteenths(settings.sub_pixel, w);
  if (stored <= 0) return refuse(InvalidReason::kOutOfRangeFar);

  int difference = 0;
  if (settings.left_right_check) {
    difference = Distance(right_index[counterpart], w.index);
    if (settings.left_right_lenient && counterpart > 0) {
      difference = Lesser(difference, Distance(right_index[counterpart - 1], w.index));
    }
  }
  if (difference > settings.left_right_tolerance) {
    if (w.index == 0) return refuse(InvalidReason::kOutOfRangeFar);
    if (w.index == last) return refuse(InvalidReason::kOutOfRangeNear);
    return refuse(Explain(grey, width, height, x, y, InvalidReason::kOccluded));
  }
  if (w.second * (100 - settings.uniqueness_percent) < w.best * 100) {
    return refuse(Explain(grey, width, height, x, y, InvalidReason::kAmbiguous));
  }
  const int margin = w.second == 0 ? 0 : 255 * (w.second - w.best) / w.second;
  const int confidence = Greater(margin >> Lesser(difference, 8), 2);
  if (confidence < settings.min_confidence) return refuse(InvalidReason::kFiltered);
  return {.stored = stored, .confidence = confidence};
}

inline constexpr int kJudgeThreads = 128;

VS_KERNEL JudgePixels(const Frame frame) {
  const int x = ThreadInGrid();
  const int y = BlockY();
  if (x >= frame.width) return;
  const int pixel = y * frame.width + x;
  const Winner winner{.index = frame.winner_index[pixel],
                      .best = frame.winner_best[pixel],
                      .second = frame.winner_second[pixel],
                      .before = frame.winner_before[pixel],
                      .after = frame.winner_after[pixel]};
  const Judged judged = JudgePixel(frame.settings, frame.grey[kLeft], frame.width, frame.height, x,
                                   y, winner, frame.right_index + ptrdiff_t{y} * frame.width);
  frame.map[0].disparity[pixel] = static_cast<uint16_t>(judged.stored);
  frame.map[0].confidence[pixel] = static_cast<uint8_t>(judged.confidence);
  frame.map[0].reason[pixel] = static_cast<uint8_t>(judged.reason);
}

// winner_..., right_index -> map[0].
template <class Launch>
void Judge(Launch& launch, const Frame& frame) {
  launch(&JudgePixels, Grid{(frame.width + kJudgeThreads - 1) / kJudgeThreads, frame.height},
         kJudgeThreads, frame);
}

}  // namespace vs::gpu
