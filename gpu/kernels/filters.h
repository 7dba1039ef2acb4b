// The filters that SgmSettings asks for, one after the other (engine/stereo/refine.h).
#pragma once

#include <cstdint>
#include <utility>

#include "engine/image/disparity_map.h"
#include "engine/stereo/selection.h"
#include "gpu/frame.h"
#include "gpu/kernels/median.h"
#include "gpu/kernels/scan.h"
#include "gpu/kernels/simt.h"
#include "gpu/kernels/speckle.h"

namespace vs::gpu {

// engine/stereo/background_fill.h, in place. A block does a row: first each pixel learns the
// nearest disparity on its left, then, coming from the other end, the one on its right.
VS_KERNEL FillBackground(const Frame frame, const DeviceMap map) {
  VS_SHARED uint32_t room[kFilterThreads];
  VS_SHARED uint16_t left[kMaxPictureWidth];  // 1 + column; 0: none
  const int width = frame.width;
  const int origin = BlockX() * width;
  const auto stored_at = [&](int x) -> uint16_t { return map.disparity[origin + x]; };
  uint32_t latest = 0;
  for (int x0 = 0; x0 < width; x0 += kFilterThreads) {
    const int x = x0 + ThreadInBlock();
    const bool valid = x < width && stored_at(x) != kInvalidDisparity;
    const uint32_t own = valid ? static_cast<uint32_t>(x) + 1 : 0;
    const uint32_t nearest = Greater(latest, JoinUpToHere(own, Greatest(), room));
    if (x < width) left[x] = static_cast<uint16_t>(nearest);
    latest = Greater(latest, room[kFilterThreads - 1]);
  }
  latest = 0;  // width - column of the nearest on the right; 0: none
  for (int begin = 0; begin < width; begin += kFilterThreads) {
    const int x = width - 1 - (begin + ThreadInBlock());
    const bool invalid = x >= 0 && stored_at(x) == kInvalidDisparity;
    const uint32_t own = x >= 0 && !invalid ? static_cast<uint32_t>(width - x) : 0;
    const uint32_t nearest = Greater(latest, JoinUpToHere(own, Greatest(), room));
    latest = Greater(latest, room[kFilterThreads - 1]);
    if (!invalid) continue;
    const uint16_t before = left[x] == 0 ? kInvalidDisparity : stored_at(left[x] - 1);
    const uint16_t after =
        nearest == 0 ? kInvalidDisparity : stored_at(width - static_cast<int>(nearest));
    const bool both = before != kInvalidDisparity && after != kInvalidDisparity;
    const uint16_t fill = both ? Lesser(before, after) : Greater(before, after);
    if (fill == kInvalidDisparity) continue;
    map.disparity[origin + x] = fill;
    map.confidence[origin + x] = kFilledConfidence;
    map.reason[origin + x] = static_cast<uint8_t>(InvalidReason::kNone);
  }
}

// map[0] -> the one of both that is returned.
template <class Launch>
DeviceMap Refine(Launch& launch, const Frame& frame) {
  const SgmSettings& settings = frame.settings;
  const Grid pixels{(frame.width + kFilterThreads - 1) / kFilterThreads, frame.height};
  DeviceMap map = frame.map[0];
  DeviceMap other = frame.map[1];
  if (settings.median > 0) {
    launch(settings.median == 5 ? &FilterMedian<5> : &FilterMedian<3>, pixels, kFilterThreads,
           frame, map, other);
    std::swap(map, other);
  }
  if (settings.speckle_size > 0) RemoveSpeckles(launch, frame, map);
  if (settings.gated_median || settings.fill_holes) {
    launch(&FilterGated, pixels, kFilterThreads, frame, map, other);
    std::swap(map, other);
  }
  if (settings.fill_background) {
    launch(&FillBackground, Grid{frame.height}, kFilterThreads, frame, map);
  }
  return map;
}

}  // namespace vs::gpu
