// What pixels are compared by (engine/stereo/pixel_cost.h), packed as frame.h says.
#pragma once

#include <cstdint>

#include "gpu/frame.h"
#include "gpu/kernels/condition.h"
#include "gpu/kernels/simt.h"

namespace vs::gpu {

// A picture that goes on beyond its border with its border pixels.
struct Endless {
  const uint8_t* pixels;
  int width;
  int height;

  VS_DEVICE int At(int x, int y) const {
    return pixels[Clamp(y, 0, height - 1) * width + Clamp(x, 0, width - 1)];
  }
};

// Horizontal gradients in place of greys (padded_picture.h).
VS_KERNEL FilterSobel(const Frame frame) {
  const int x = ThreadInGrid();
  const int view = BlockY() / frame.height;
  const int y = BlockY() % frame.height;
  if (x >= frame.width) return;
  const Endless grey{frame.grey[view], frame.width, frame.height};
  const auto step = [&](int row) { return grey.At(x + 1, row) - grey.At(x - 1, row); };
  const int cap = frame.settings.sobel_cap;
  const int gradient = 2 * step(y) + step(y - 1) + step(y + 1);
  frame.across[view][y * frame.width + x] = static_cast<uint8_t>(Clamp(gradient, -cap, cap) + cap);
}

struct CensusCode {
  uint32_t low;
  uint32_t high;
};

// The neighbours of a box of +-kReachX, +-kReachY whose members lie 1 .. kStrides apart, one box
// after the other (census.h; the order of the bits does not matter).
template <int kReachX, int kReachY, int kStrides>
VS_DEVICE CensusCode CensusAt(const Endless& picture, int x, int y) {
  const int centre = picture.At(x, y);
  uint64_t code = 0;
  for (int stride = 1; stride <= kStrides; ++stride) {
    for (int dy = -kReachY; dy <= kReachY; ++dy) {
      for (int dx = -kReachX; dx <= kReachX; ++dx) {
        if (dx == 0 && dy == 0) continue;
        const int neighbour = picture.At(x + dx * stride, y + dy * stride);
        code = code << 1 | (neighbour < centre ? 1U : 0U);
      }
    }
  }
  return {static_cast<uint32_t>(code), static_cast<uint32_t>(code >> 32)};
}

VS_DEVICE CensusCode CensusAt(CensusPattern pattern, const Endless& picture, int x, int y) {
  switch (pattern) {
    case CensusPattern::k5x5:
      return CensusAt<2, 2, 1>(picture, x, y);
    case CensusPattern::k7x7:
      return CensusAt<3, 3, 1>(picture, x, y);
    case CensusPattern::k9x7:
      return CensusAt<4, 3, 1>(picture, x, y);
    default:
      return CensusAt<1, 1, 3>(picture, x, y);
  }
}

VS_HOST_DEVICE bool IsCensus(MatchCost cost) {
  return cost == MatchCost::kCensus || cost == MatchCost::kAdCensus;
}
VS_HOST_DEVICE bool IsLongCode(CensusPattern pattern) {
  return pattern == CensusPattern::k7x7 || pattern == CensusPattern::k9x7;
}

VS_KERNEL MakeCodes(const Frame frame) {
  const int x = ThreadInGrid();
  const int view = BlockY() / frame.height;
  const int y = BlockY() % frame.height;
  if (x >= frame.width) return;
  const SgmSettings& settings = frame.settings;
  const Endless picture{settings.sobel_cap > 0 ? frame.across[view] : frame.grey[view], frame.width,
                        frame.height};
  const int pixel = y * frame.width + x;
  const int value = picture.At(x, y);
  const auto coarse = static_cast<uint32_t>(value + 2) >> 2;
  if (IsCensus(settings.cost)) {
    const CensusCode code = CensusAt(settings.census, picture, x, y);
    const bool in_word = !IsLongCode(settings.census);
    frame.code[view][pixel] = in_word ? code.low | coarse << 24 : code.low;
    if (in_word) return;
    frame.code_high[view][pixel] = code.high;
    frame.coarse[view][pixel] = static_cast<uint8_t>(coarse);
    return;
  }
  const int before = (value + picture.At(x - 1, y) + 1) >> 1;
  const int after = (value + picture.At(x + 1, y) + 1) >> 1;
  const int low = Lesser(value, Lesser(before, after));
  const int high = Greater(value, Greater(before, after));
  frame.code[view][pixel] = static_cast<uint32_t>(value | low << 8 | high << 16);
}

// grey -> code.
template <class Launch>
void MakeFeatures(Launch& launch, const Frame& frame) {
  if (frame.settings.sobel_cap > 0) {
    launch(&FilterSobel, PixelsOfBothViews(frame), kPixelThreads, frame);
  }
  launch(&MakeCodes, PixelsOfBothViews(frame), kPixelThreads, frame);
}

}  // namespace vs::gpu
