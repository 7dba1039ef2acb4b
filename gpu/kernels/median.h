// Medians of windows: the plain one (engine/stereo/median_filter.h) and, over pixels of similar
// grey, the gated one and the filling of holes (engine/stereo/gated_filter.h). A thread for each
// pixel; what neighbours read should be in the cache.
#pragma once

#include <cstdint>

#include "engine/image/disparity_map.h"
#include "engine/stereo/selection.h"
#include "gpu/frame.h"
#include "gpu/kernels/simt.h"

namespace vs::gpu {

inline constexpr int kFilterThreads = 128;

VS_DEVICE void Order(uint32_t& low, uint32_t& high) {
  const uint32_t less = Lesser(low, high);
  high = Greater(low, high);
  low = less;
}

// The median of kCount values, an odd number. By forgetful selection: of any kCount / 2 + 2 values
// neither the least nor the greatest can be the median, so both are forgotten and one more is
// looked at. All indices are known when this is compiled, so the values stay in registers.
template <int kCount>
VS_DEVICE uint32_t MedianOf(uint32_t (&values)[kCount]) {
  constexpr int kHeld = kCount / 2 + 2;
  VS_UNROLL
  for (int first = 0; first < kHeld - 2; ++first) {
    // The least of values[first .. kHeld - 1] goes to the front, the greatest to the end.
    VS_UNROLL
    for (int k = first + 1; k < kHeld; ++k) Order(values[first], values[k]);
    VS_UNROLL
    for (int k = first + 1; k < kHeld - 1; ++k) Order(values[k], values[kHeld - 1]);
    // The greatest gives its place to the next one.
    if (kHeld + first < kCount) values[kHeld - 1] = values[kHeld + first];
  }
  return values[kHeld - 2];
}

template <int kSize>
VS_KERNEL FilterMedian(const Frame frame, const DeviceMap in, const DeviceMap out) {
  const int x = ThreadInGrid();
  const int y = BlockY();
  if (x >= frame.width) return;
  uint32_t values[kSize * kSize];
  VS_UNROLL
  for (int k = 0; k < kSize * kSize; ++k) {
    const int u = Clamp(x + k % kSize - kSize / 2, 0, frame.width - 1);
    const int v = Clamp(y + k / kSize - kSize / 2, 0, frame.height - 1);
    values[k] = in.disparity[v * frame.width + u];
  }
  const int pixel = y * frame.width + x;
  const bool was_valid = in.disparity[pixel] != kInvalidDisparity;
  const auto median = static_cast<uint16_t>(MedianOf(values));
  const bool is_valid = median != kInvalidDisparity;
  out.disparity[pixel] = median;
  out.confidence[pixel] =
      is_valid ? Greater(in.confidence[pixel], kFilledConfidence) : static_cast<uint8_t>(0);
  const auto lost = was_valid ? static_cast<uint8_t>(InvalidReason::kFiltered) : in.reason[pixel];
  out.reason[pixel] = is_valid ? static_cast<uint8_t>(InvalidReason::kNone) : lost;
}

// Pixels that are no members count in turn as greater and as less than any member, so that the
// median of all is the member of rank count / 2.
VS_DEVICE uint16_t GatedMedian(const Frame& frame, const uint16_t* disparity, int x, int y) {
  constexpr int kSize = 5;
  const uint8_t* const grey = frame.grey[kLeft];
  const int centre = grey[y * frame.width + x];
  uint32_t values[kSize * kSize];
  uint32_t stand_in = 0;
  VS_UNROLL
  for (int k = 0; k < kSize * kSize; ++k) {
    const int u = x + k % kSize - kSize / 2;
    const int v = y + k / kSize - kSize / 2;
    const bool inside = u >= 0 && u < frame.width && v >= 0 && v < frame.height;
    const int pixel = inside ? v * frame.width + u : 0;
    const uint32_t stored = inside ? disparity[pixel] : kInvalidDisparity;
    const bool member =
        stored != kInvalidDisparity && Distance(grey[pixel], centre) <= frame.settings.gate;
    if (!member) stand_in ^= 0xffff;
    values[k] = member ? stored : stand_in;
  }
  return static_cast<uint16_t>(MedianOf(values));
}

// What a hole is filled with; kInvalidDisparity when its members are too few or disagree. The
// window is read once: it is looked at about as often as a median has bits, so it stays in
// registers.
VS_DEVICE uint16_t FillValue(const Frame& frame, const uint16_t* disparity, int x, int y) {
  constexpr int kSize = 7;
  constexpr int kLeastMembers = 12;
  constexpr int kNoMember = 0x10000;  // greater than any
  const uint8_t* const grey = frame.grey[kLeft];
  const int centre = grey[y * frame.width + x];
  int members[kSize * kSize];
  int count = 0;
  int least = kNoMember;
  int greatest = 0;
  VS_UNROLL
  for (int k = 0; k < kSize * kSize; ++k) {
    const int u = x + k % kSize - kSize / 2;
    const int v = y + k / kSize - kSize / 2;
    members[k] = kNoMember;
    if (u < 0 || u >= frame.width || v < 0 || v >= frame.height) continue;
    const int pixel = v * frame.width + u;
    const int stored = disparity[pixel];
    if (stored == kInvalidDisparity || Distance(grey[pixel], centre) > frame.settings.gate)
      continue;
    members[k] = stored;
    ++count;
    least = Lesser(least, stored);
    greatest = Greater(greatest, stored);
  }
  if (count < kLeastMembers) return kInvalidDisparity;
  // The greatest value that at most count / 2 members lie below, bit by bit of what it may exceed
  // the least member by.
  int bit = 1;
  while (2 * bit <= greatest - least) bit *= 2;
  int median = least;
  for (; bit != 0; bit /= 2) {
    const int limit = median + bit;
    int below = 0;
    VS_UNROLL
    for (int k = 0; k < kSize * kSize; ++k) below += members[k] < limit ? 1 : 0;
    if (limit <= greatest && below <= count / 2) median = limit;
  }
  int agreeing = 0;
  VS_UNROLL
  for (int k = 0; k < kSize * kSize; ++k) {
    agreeing += Distance(members[k], median) <= kDisparityScale && members[k] != kNoMember ? 1 : 0;
  }
  return agreeing * 10 >= count * 7 ? static_cast<uint16_t>(median) : kInvalidDisparity;
}

VS_KERNEL FilterGated(const Frame frame, const DeviceMap in, const DeviceMap out) {
  const int x = ThreadInGrid();
  const int y = BlockY();
  if (x >= frame.width) return;
  const int pixel = y * frame.width + x;
  uint16_t stored = in.disparity[pixel];
  uint8_t confidence = in.confidence[pixel];
  uint8_t reason = in.reason[pixel];
  if (stored != kInvalidDisparity) {
    if (frame.settings.gated_median) stored = GatedMedian(frame, in.disparity, x, y);
  } else if (frame.settings.fill_holes) {
    stored = FillValue(frame, in.disparity, x, y);
    if (stored != kInvalidDisparity) {
      confidence = kFilledConfidence;
      reason = static_cast<uint8_t>(InvalidReason::kNone);
    }
  }
  out.disparity[pixel] = stored;
  out.confidence[pixel] = confidence;
  out.reason[pixel] = reason;
}

}  // namespace vs::gpu
