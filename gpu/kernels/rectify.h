// Rectified pictures of raw ones: the rules of engine/image/{remap,resample}.h, a thread for each
// pixel. A warp reads what lies together, so the cache should give nearly all of it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/image/remap.h"
#include "gpu/frame.h"
#include "gpu/kernels/rounded_float.h"
#include "gpu/kernels/simt.h"

namespace vs::gpu {

struct DevicePicture {
  const uint8_t* pixels;
  int width;
  int height;

  VS_DEVICE bool Has(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  VS_DEVICE const uint8_t* At(int x, int y) const {
    return pixels + static_cast<size_t>(y) * width + x;
  }
};

// A pixel and what part of the way to its right and lower neighbours.
template <class Part>
struct TablePlace {
  int x;
  int y;
  Part x_part;
  Part y_part;
};

// Places in 1/32 px, whole numbers.
struct FixedTable {
  using Part = int;
  using Weight = int;
  using Sum = int64_t;
  static constexpr int kParts = 32;

  VS_DEVICE static TablePlace<Part> PlaceOf(const Frame& frame, int view, int pixel) {
    const RemapTable::Source source = frame.sources[view][pixel];
    return {source.x, source.y, source.x_part, source.y_part};
  }
  VS_DEVICE static bool IsHalf(Part part) { return part >= kParts / 2; }
  VS_DEVICE static Weight WeightOf(uint8_t grey) { return grey; }
  VS_DEVICE static void SetWeights(Part t, Weight (&weights)[2]) {
    weights[0] = kParts - t;
    weights[1] = t;
  }
  VS_DEVICE static void SetWeights(Part t, Weight (&weights)[4]) {
    const int s = kParts - t;
    constexpr int kNine = 9 * kParts;
    weights[0] = -3 * t * s * s;
    weights[1] = (5 * t - kNine) * t * t + (1 << 17);
    weights[2] = (5 * s - kNine) * s * s + (1 << 17);
    weights[3] = -3 * s * t * t;
  }
  template <int kTaps>
  VS_DEVICE static uint8_t Grey(Sum sum) {
    constexpr int kBits = kTaps == 2 ? 10 : 34;
    const Sum grey = (sum + (Sum{1} << (kBits - 1))) >> kBits;
    return static_cast<uint8_t>(grey < 0 ? 0 : grey > 255 ? 255 : grey);
  }
  VS_DEVICE static uint8_t MixFour(const uint8_t* above, const uint8_t* below, Part x_part,
                                   Part y_part) {
    const int top = kParts * above[0] + x_part * (above[1] - above[0]);
    const int bottom = kParts * below[0] + x_part * (below[1] - below[0]);
    return static_cast<uint8_t>((top * (kParts - y_part) + bottom * y_part + 512) >> 10);
  }
};

// Places in floats.
struct ExactTable {
  using Part = RoundedFloat;
  using Weight = RoundedFloat;
  using Sum = RoundedFloat;

  VS_DEVICE static TablePlace<Part> PlaceOf(const Frame& frame, int view, int pixel) {
    constexpr float kFar = 32768;
    const RemapTable::Position at = frame.positions[view][pixel];
    // What is not a number is not near.
    const bool near = at.x > -kFar && at.x < kFar && at.y > -kFar && at.y < kFar;
    const float x = near ? at.x : -kFar;
    const float y = near ? at.y : -kFar;
    const int left = RoundedDown(x);
    const int top = RoundedDown(y);
    return {left, top, RoundedFloat{x} - Whole(left), RoundedFloat{y} - Whole(top)};
  }
  VS_DEVICE static bool IsHalf(Part part) { return part.value >= 0.5F; }
  VS_DEVICE static Weight WeightOf(uint8_t grey) { return Whole(grey); }
  VS_DEVICE static void SetWeights(Part t, Weight (&weights)[2]) {
    weights[0] = RoundedFloat{1} - t;
    weights[1] = t;
  }
  VS_DEVICE static void SetWeights(Part t, Weight (&weights)[4]) {
    const RoundedFloat s = RoundedFloat{1} - t;
    weights[0] = RoundedFloat{-0.75F} * t * s * s;
    weights[1] = Inner(t);
    weights[2] = Inner(s);
    weights[3] = RoundedFloat{-0.75F} * s * t * t;
  }
  template <int kTaps>
  VS_DEVICE static uint8_t Grey(Sum sum) {
    const float grey = (sum + RoundedFloat{0.5F}).value;
    return static_cast<uint8_t>(grey < 0.0F ? 0.0F : grey > 255.0F ? 255.0F : grey);
  }
  VS_DEVICE static uint8_t MixFour(const uint8_t* above, const uint8_t* below, Part x_part,
                                   Part y_part) {
    const RoundedFloat a = Whole(above[0]);
    const RoundedFloat c = Whole(below[0]);
    const RoundedFloat top = a + x_part * (Whole(above[1]) - a);
    const RoundedFloat bottom = c + x_part * (Whole(below[1]) - c);
    const RoundedFloat grey = top + y_part * (bottom - top) + RoundedFloat{0.5F};
    return static_cast<uint8_t>(static_cast<int>(grey.value));
  }

 private:
  VS_DEVICE static RoundedFloat Whole(int value) { return {static_cast<float>(value)}; }
  VS_DEVICE static int RoundedDown(float value) {
    const int whole = static_cast<int>(value);
    return whole - (static_cast<float>(whole) > value ? 1 : 0);
  }
  VS_DEVICE static RoundedFloat Inner(RoundedFloat t) {
    return (RoundedFloat{1.25F} * t - RoundedFloat{2.25F}) * t * t + RoundedFloat{1};
  }
};

// The weighted sum of the kTaps x kTaps pixels about a place, wherever it is.
template <class Table, int kTaps>
VS_DEVICE uint8_t WeightedSum(const DevicePicture& in,
                              const TablePlace<typename Table::Part>& place) {
  typename Table::Weight across[kTaps];
  typename Table::Weight down[kTaps];
  Table::SetWeights(place.x_part, across);
  Table::SetWeights(place.y_part, down);
  typename Table::Sum sum{};
  for (int v = 0; v < kTaps; ++v) {
    typename Table::Weight row_sum{};
    for (int u = 0; u < kTaps; ++u) {
      const int x = place.x + 1 - kTaps / 2 + u;
      const int y = place.y + 1 - kTaps / 2 + v;
      if (in.Has(x, y)) row_sum = row_sum + across[u] * Table::WeightOf(*in.At(x, y));
    }
    sum = sum + typename Table::Sum{down[v]} * row_sum;
  }
  return Table::template Grey<kTaps>(sum);
}

template <class Table, Interpolation kInterpolation>
VS_DEVICE uint8_t GreyAt(const DevicePicture& in, const TablePlace<typename Table::Part>& place) {
  if constexpr (kInterpolation == Interpolation::kNearest) {
    const int x = place.x + (Table::IsHalf(place.x_part) ? 1 : 0);
    const int y = place.y + (Table::IsHalf(place.y_part) ? 1 : 0);
    return in.Has(x, y) ? *in.At(x, y) : uint8_t{0};
  } else if constexpr (kInterpolation == Interpolation::kCubic) {
    return WeightedSum<Table, 4>(in, place);
  } else {
    if (!in.Has(place.x, place.y) || !in.Has(place.x + 1, place.y + 1)) {
      return WeightedSum<Table, 2>(in, place);
    }
    const uint8_t* const at = in.At(place.x, place.y);
    return Table::MixFour(at, at + in.width, place.x_part, place.y_part);
  }
}

inline constexpr int kRectifyThreads = 128;

// Row y of both views: the left one's come first.
VS_KERNEL HalvePictures(const Frame frame) {
  const int width = frame.raw_width / 2;
  const int height = frame.raw_height / 2;
  const int view = BlockY() / height;
  const int y = BlockY() % height;
  const int x = ThreadInGrid();
  if (x >= width) return;
  const uint8_t* const above =
      frame.uploaded[view] + size_t{2} * y * frame.raw_width + ptrdiff_t{2} * x;
  const uint8_t* const below = above + frame.raw_width;
  const int sum = above[0] + above[1] + below[0] + below[1];
  frame.halved[view][static_cast<size_t>(y) * width + x] = static_cast<uint8_t>((sum + 2) / 4);
}

template <class Table, Interpolation kInterpolation>
VS_KERNEL RectifyPixels(const Frame frame) {
  const int view = BlockY() / frame.height;
  const int y = BlockY() % frame.height;
  const int x = ThreadInGrid();
  if (x >= frame.width) return;
  const bool halved = frame.halved[view] != nullptr;
  const DevicePicture in{halved ? frame.halved[view] : frame.uploaded[view],
                         halved ? frame.raw_width / 2 : frame.raw_width,
                         halved ? frame.raw_height / 2 : frame.raw_height};
  const int pixel = y * frame.width + x;
  frame.input[view][pixel] = GreyAt<Table, kInterpolation>(in, Table::PlaceOf(frame, view, pixel));
}

template <class Table, class Launch>
void RectifyBy(Launch& launch, const Frame& frame) {
  const Grid grid{(frame.width + kRectifyThreads - 1) / kRectifyThreads, 2 * frame.height};
  switch (frame.interpolation) {
    case Interpolation::kNearest:
      launch(&RectifyPixels<Table, Interpolation::kNearest>, grid, kRectifyThreads, frame);
      break;
    case Interpolation::kLinear:
      launch(&RectifyPixels<Table, Interpolation::kLinear>, grid, kRectifyThreads, frame);
      break;
    case Interpolation::kCubic:
      launch(&RectifyPixels<Table, Interpolation::kCubic>, grid, kRectifyThreads, frame);
      break;
  }
}

// uploaded -> input, unless they are the same.
template <class Launch>
void Rectify(Launch& launch, const Frame& frame) {
  if (!frame.Rectifies()) return;
  if (frame.halved[kLeft] != nullptr) {
    const int blocks = (frame.raw_width / 2 + kRectifyThreads - 1) / kRectifyThreads;
    launch(&HalvePictures, Grid{blocks, frame.raw_height / 2 * 2}, kRectifyThreads, frame);
  }
  if (frame.positions[kLeft] == nullptr) {
    RectifyBy<FixedTable>(launch, frame);
  } else {
    RectifyBy<ExactTable>(launch, frame);
  }
}

}  // namespace vs::gpu
