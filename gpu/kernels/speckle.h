// Removes small regions (engine/stereo/speckle_filter.h).
//
// Regions are trees of pixels: label[p] names another pixel of p's region, the root names itself.
// The pixels of a run in a row name its first one. Then all runs that touch in neighbouring rows
// are joined at once: a root is given the lesser of two names by an atomic minimum, and who comes
// too late goes on from the name that he found there (Playne, Hawick 2018). Last, each run adds its
// length to its root's count, unless that is large enough already: so the largest regions, in which
// all would meet, cost the least.
//
// All rows are joined at once, so that names form chains as long as the picture is high. Whoever
// follows a chain shortens it for those after him; as all do, the length shrinks to its logarithm.
// Only the first pixels of runs are on chains: the others name theirs for good.
#pragma once

#include <cstdint>

#include "engine/image/disparity_map.h"
#include "gpu/frame.h"
#include "gpu/kernels/scan.h"
#include "gpu/kernels/simt.h"

namespace vs::gpu {

inline constexpr int kSpeckleThreads = 128;

VS_DEVICE bool Connected(int a, int b, int max_step) {
  return a != kInvalidDisparity && b != kInvalidDisparity && Distance(a, b) <= max_step;
}

// The root above the first pixel of a run. Each pixel on the way is made to name the one after the
// next: an older, greater name of its region is all that others may read or write meanwhile.
VS_DEVICE uint32_t RootOf(uint32_t* label, uint32_t pixel) {
  for (;;) {
    const uint32_t named = ReadShared(&label[pixel]);
    if (named == pixel) return pixel;
    const uint32_t next = ReadShared(&label[named]);
    if (next == named) return named;
    AtomicMin(&label[pixel], next);
    pixel = next;
  }
}

// Of first pixels of runs.
VS_DEVICE void JoinRegions(uint32_t* label, uint32_t a, uint32_t b) {
  for (;;) {
    a = RootOf(label, a);
    b = RootOf(label, b);
    if (a == b) return;
    const uint32_t lesser = Lesser(a, b);
    const uint32_t greater = Greater(a, b);
    const uint32_t named = AtomicMin(&label[greater], lesser);
    if (named == greater) return;
    // It was no root any more; what it named must be joined too.
    a = named;
    b = lesser;
  }
}

// A block does a row: each pixel names the first of its run. Invalid pixels name themselves.
VS_KERNEL LabelRuns(const Frame frame, const uint16_t* disparity, int max_step) {
  VS_SHARED uint32_t room[kSpeckleThreads];
  const int y = BlockX();
  const int origin = y * frame.width;
  uint32_t begun = 0;  // 1 + first pixel of the latest run in the columns before these
  for (int x0 = 0; x0 < frame.width; x0 += kSpeckleThreads) {
    const int x = x0 + ThreadInBlock();
    const int pixel = origin + x;
    const bool inside = x < frame.width;
    const bool goes_on =
        inside && x > 0 && Connected(disparity[pixel], disparity[pixel - 1], max_step);
    const uint32_t begins = goes_on ? 0 : static_cast<uint32_t>(pixel) + 1;
    const uint32_t first = Greater(begun, JoinUpToHere(begins, Greatest(), room));
    if (inside) {
      frame.label[pixel] = first - 1;
      frame.region[pixel] = 0;
    }
    begun = Greater(begun, room[kSpeckleThreads - 1]);
  }
}

VS_KERNEL JoinRows(const Frame frame, const uint16_t* disparity, int max_step) {
  const int x = ThreadInGrid();
  const int y = BlockY() + 1;
  if (x >= frame.width) return;
  const int pixel = y * frame.width + x;
  const int above = pixel - frame.width;
  if (!Connected(disparity[pixel], disparity[above], max_step)) return;
  // The pixel to the left joins the same two runs.
  if (x > 0 && Connected(disparity[pixel - 1], disparity[above - 1], max_step) &&
      Connected(disparity[pixel - 1], disparity[pixel], max_step) &&
      Connected(disparity[above - 1], disparity[above], max_step)) {
    return;
  }
  JoinRegions(frame.label, ReadShared(&frame.label[pixel]), ReadShared(&frame.label[above]));
}

VS_KERNEL CountRegions(const Frame frame, const uint16_t* disparity, int max_step) {
  const int x = ThreadInGrid();
  const int y = BlockY();
  if (x >= frame.width) return;
  const int pixel = y * frame.width + x;
  if (disparity[pixel] == kInvalidDisparity) return;
  const auto linked = [&](int p) { return Connected(disparity[p], disparity[p - 1], max_step); };
  if (x + 1 < frame.width && linked(pixel + 1)) return;  // its last pixel counts a run
  const auto last = static_cast<uint32_t>(pixel);
  const uint32_t first = x > 0 && linked(pixel) ? frame.label[pixel] : last;
  const uint32_t root = RootOf(frame.label, first);
  AtomicMin(&frame.label[first], root);  // the least of its region, so it stays
  uint32_t* const count = &frame.region[root];
  if (ReadShared(count) > static_cast<uint32_t>(frame.settings.speckle_size)) return;
  AtomicAdd(count, last - first + 1);
}

VS_KERNEL RemoveRegions(const Frame frame, const DeviceMap map) {
  const int x = ThreadInGrid();
  if (x >= frame.width) return;
  const int pixel = BlockY() * frame.width + x;
  if (map.disparity[pixel] == kInvalidDisparity) return;
  const uint32_t root = frame.label[frame.label[pixel]];  // its run's first pixel names it
  if (frame.region[root] > static_cast<uint32_t>(frame.settings.speckle_size)) return;
  map.disparity[pixel] = kInvalidDisparity;
  map.confidence[pixel] = 0;
  map.reason[pixel] = static_cast<uint8_t>(InvalidReason::kSpeckle);
}

// In place.
template <class Launch>
void RemoveSpeckles(Launch& launch, const Frame& frame, const DeviceMap& map) {
  const int max_step = kDisparityScale * frame.settings.speckle_step;
  const Grid pixels{(frame.width + kSpeckleThreads - 1) / kSpeckleThreads, frame.height};
  launch(&LabelRuns, Grid{frame.height}, kSpeckleThreads, frame, map.disparity, max_step);
  launch(&JoinRows, Grid{pixels.x, frame.height - 1}, kSpeckleThreads, frame, map.disparity,
         max_step);
  launch(&CountRegions, pixels, kSpeckleThreads, frame, map.disparity, max_step);
  launch(&RemoveRegions, pixels, kSpeckleThreads, frame, map);
}

}  // namespace vs::gpu
