#pragma once

#include <cstdint>
#include <initializer_list>
#include <random>
#include <vector>

#include "engine/image/buffer.h"
#include "engine/image/disparity_map.h"
#include "engine/image/image.h"
#include "engine/stereo/selection.h"

namespace vs {

// Small pictures written out in a test, row by row.
template <class T>
Image<T> MakeImage(BufferPool& pool, std::initializer_list<std::initializer_list<T>> rows) {
  Image<T> image(pool, static_cast<int>(rows.begin()->size()), static_cast<int>(rows.size()));
  int y = 0;
  for (const auto& row : rows) std::copy(row.begin(), row.end(), image.Row(y++));
  return image;
}

template <class T>
std::vector<std::vector<T>> RowsOf(const Image<T>& image) {
  std::vector<std::vector<T>> rows;
  rows.reserve(static_cast<size_t>(image.height()));
  for (int y = 0; y < image.height(); ++y) {
    rows.emplace_back(image.Row(y), image.Row(y) + image.width());
  }
  return rows;
}

// A map of these stored disparities: confidence 200 and no reason where valid, else occluded.
inline DisparityMap MakeMap(BufferPool& pool, const Image<uint16_t>& disparity) {
  DisparityMap map{.disparity = disparity,
                   .confidence = GreyImage(pool, disparity.width(), disparity.height()),
                   .reason = GreyImage(pool, disparity.width(), disparity.height())};
  map.geometry.width = disparity.width();
  map.geometry.height = disparity.height();
  for (int y = 0; y < disparity.height(); ++y) {
    for (int x = 0; x < disparity.width(); ++x) {
      const bool valid = disparity.Row(y)[x] != kInvalidDisparity;
      map.confidence.Row(y)[x] = valid ? 200 : 0;
      map.reason.Row(y)[x] =
          static_cast<uint8_t>(valid ? InvalidReason::kNone : InvalidReason::kOccluded);
    }
  }
  return map;
}

inline DisparityMap MakeMap(BufferPool& pool,
                            std::initializer_list<std::initializer_list<uint16_t>> rows) {
  return MakeMap(pool, MakeImage<uint16_t>(pool, rows));
}

// A map of the same size, to be written.
inline DisparityMap EmptyLike(BufferPool& pool, const DisparityMap& map) {
  const int width = map.disparity.width();
  const int height = map.disparity.height();
  return {.disparity = Image<uint16_t>(pool, width, height),
          .confidence = GreyImage(pool, width, height),
          .reason = GreyImage(pool, width, height),
          .offset_px = map.offset_px,
          .geometry = map.geometry};
}

inline int Below(std::mt19937& random, int limit) {
  return static_cast<int>(random() % static_cast<unsigned>(limit));
}

// A random picture that can be matched: the right one is the left one moved by a disparity that
// changes from block to block, with some noise; a few areas are flat, dark or overexposed.
struct RandomPair {
  GreyImage left;
  GreyImage right;
};

inline RandomPair MakeRandomPair(BufferPool& pool, int width, int height, std::mt19937& random) {
  RandomPair pair{GreyImage(pool, width, height), GreyImage(pool, width, height)};
  const int smooth = Below(random, 3);
  for (int y = 0; y < height; ++y) {
    uint8_t* left = pair.left.Row(y);
    for (int x = 0; x < width; ++x) {
      const int grey = Below(random, 256);
      left[x] = static_cast<uint8_t>(
          x > 0 && smooth > 0 ? (left[x - 1] * smooth + grey) / (smooth + 1) : grey);
    }
  }
  const int flat_grey[] = {0, 2, 3, 120, 254, 255};
  for (int k = 0; k < 3; ++k) {
    const int grey = flat_grey[Below(random, 6)];
    const int x0 = Below(random, width);
    const int y0 = Below(random, height);
    for (int y = y0; y < std::min(height, y0 + 7); ++y) {
      for (int x = x0; x < std::min(width, x0 + 9); ++x) {
        pair.left.Row(y)[x] = static_cast<uint8_t>(std::max(0, grey - Below(random, 2)));
      }
    }
  }
  const int shift = Below(random, 9) - 2;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int disparity = shift + (x / 8 + y / 8) % 3;
      const int from = std::clamp(x + disparity, 0, width - 1);
      const int grey = pair.left.Row(y)[from] + Below(random, 5) - 2;
      pair.right.Row(y)[x] = static_cast<uint8_t>(std::clamp(grey, 0, 255));
    }
  }
  return pair;
}

}  // namespace vs
