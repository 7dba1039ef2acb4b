#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <random>

#include "engine/image/image.h"
#include "engine/image/rectification.h"
#include "tests/engine/stereo/random_settings.h"

namespace vs {

struct RectificationKind {
  Interpolation interpolation = Interpolation::kLinear;
  bool exact = false;
  bool half_size = false;
  // Places up to so far beside the straight one, px; one of each 16 is anywhere, or nowhere.
  int wild_px = 2;
};

// Of a view of width x height px; the places are a random walk about the straight ones.
inline RemapTable MakeRandomTable(int width, int height, const RectificationKind& kind,
                                  std::mt19937& random) {
  RemapTable table;
  table.width = width;
  table.height = height;
  const auto part = [&] { return static_cast<uint8_t>(Below(random, 32)); };
  const auto near = [&](int value) {
    return value + Below(random, 2 * kind.wild_px + 1) - kind.wild_px;
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool lost = Below(random, 16) == 0;
      const int u = lost ? Below(random, 65536) - 32768 : near(x);
      const int v = lost && Below(random, 2) == 0 ? Below(random, 65536) - 32768 : near(y);
      if (kind.exact) {
        constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();
        constexpr float kFar = 1e30F;
        const auto place = [&](int whole) {
          const int what = lost ? Below(random, 8) : 8;
          if (what == 0) return kNowhere;
          if (what == 1) return -kFar;
          // Whole numbers and halves, too: there the rules change.
          const int fine = Below(random, 4) == 0 ? 2048 * Below(random, 2) : Below(random, 4096);
          return static_cast<float>(whole) + static_cast<float>(fine) / 4096;
        };
        table.positions.push_back({place(u), place(v)});
      } else {
        table.sources.push_back({.x = static_cast<int16_t>(u),
                                 .y = static_cast<int16_t>(v),
                                 .x_part = part(),
                                 .y_part = part()});
      }
    }
  }
  return table;
}

// For pictures like `raw`, to ideal ones of width x height px.
inline std::shared_ptr<const Rectification> MakeRandomRectification(
    const GreyImage& raw, int width, int height, std::mt19937& random,
    const RectificationKind& kind = {}) {
  auto made = std::make_shared<Rectification>();
  made->raw_width = raw.width();
  made->raw_height = raw.height();
  made->half_size = kind.half_size;
  made->interpolation = kind.interpolation;
  made->left = MakeRandomTable(width, height, kind, random);
  made->right = MakeRandomTable(width, height, kind, random);
  made->geometry = {.width = width,
                    .height = height,
                    .focal_px = 533.5,
                    .baseline_m = 0.1213,
                    .cx_px = 24.5,
                    .cy_px = 11.25,
                    .principal_offset_px = 0.375};
  return made;
}

}  // namespace vs
