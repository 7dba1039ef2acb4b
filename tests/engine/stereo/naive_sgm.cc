#include "tests/engine/stereo/naive_sgm.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "engine/stereo/condition_pair.h"

namespace vs {
namespace {

using Point = std::pair<int, int>;

class Naive {
 public:
  Naive(const GreyImage& left, const GreyImage& right, const SgmSettings& settings)
      : left_(left),
        right_(right),
        s_(settings),
        width_(left.width()),
        height_(left.height()),
        count_(settings.num_disparities) {}

  DisparityMap Run(BufferPool& pool) {
    costs_ = WindowCosts();
    SumPaths();
    DisparityMap map{.disparity = Image<uint16_t>(pool, width_, height_),
                     .confidence = GreyImage(pool, width_, height_),
                     .reason = GreyImage(pool, width_, height_),
                     .offset_px = s_.min_disparity < 0 ? s_.min_disparity - 1 : 0};
    map.geometry.width = width_;
    map.geometry.height = height_;
    Select();
    if (s_.median > 0) Median();
    if (s_.speckle_size > 0) RemoveSpeckles();
    GatedFilters();
    if (s_.fill_background) FillBackground();
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        const Pixel& pixel = At(x, y);
        map.disparity.Row(y)[x] = static_cast<uint16_t>(pixel.stored);
        map.confidence.Row(y)[x] = static_cast<uint8_t>(pixel.confidence);
        map.reason.Row(y)[x] = static_cast<uint8_t>(pixel.reason);
      }
    }
    return map;
  }

 private:
  struct Pixel {
    int stored = 0;
    int confidence = 0;
    InvalidReason reason = InvalidReason::kNone;
  };

  static int Average(int a, int b) { return (a + b + 1) / 2; }
  int Grey(const GreyImage& image, int x, int y) const {
    return image.Row(std::clamp(y, 0, height_ - 1))[std::clamp(x, 0, width_ - 1)];
  }
  // The picture that costs see, extended beyond its border.
  int Input(const GreyImage& image, int x, int y) const {
    x = std::clamp(x, 0, width_ - 1);
    y = std::clamp(y, 0, height_ - 1);
    if (s_.sobel_cap == 0) return Grey(image, x, y);
    int gradient = 0;
    for (int dy = -1; dy <= 1; ++dy) {
      gradient += (dy == 0 ? 2 : 1) * (Grey(image, x + 1, y + dy) - Grey(image, x - 1, y + dy));
    }
    return std::clamp(gradient, -s_.sobel_cap, s_.sobel_cap) + s_.sobel_cap;
  }
  bool Inside(int x, int i) const {
    const int counterpart = x - s_.min_disparity - i;
    return counterpart >= 0 && counterpart < width_;
  }
  size_t Cell(int x, int y, int i) const {
    return (static_cast<size_t>(y) * width_ + x) * count_ + i;
  }

  std::vector<Point> Neighbours() const {
    std::vector<Point> points;
    const auto box = [&](int rx, int ry, int stride) {
      for (int dy = -ry; dy <= ry; ++dy) {
        for (int dx = -rx; dx <= rx; ++dx) {
          if (dx != 0 || dy != 0) points.emplace_back(dx * stride, dy * stride);
        }
      }
    };
    if (s_.census == CensusPattern::k5x5) box(2, 2, 1);
    if (s_.census == CensusPattern::k7x7) box(3, 3, 1);
    if (s_.census == CensusPattern::k9x7) box(4, 3, 1);
    if (s_.census == CensusPattern::kStrided3x3) {
      for (const int stride : {1, 2, 3}) box(1, 1, stride);
    }
    return points;
  }

  int CensusDistance(int x, int xr, int y) const {
    int distance = 0;
    for (const auto& [dx, dy] : Neighbours()) {
      const bool in_left = Input(left_, x + dx, y + dy) < Input(left_, x, y);
      const bool in_right = Input(right_, xr + dx, y + dy) < Input(right_, xr, y);
      distance += in_left != in_right ? 1 : 0;
    }
    return Neighbours().size() > 24 ? (distance + 1) / 2 : distance;
  }

  // How far `value` lies outside the values about pixel x of `image`.
  int Outside(int value, const GreyImage& image, int x, int y) const {
    const int here = Input(image, x, y);
    const int before = Average(here, Input(image, x - 1, y));
    const int after = Average(here, Input(image, x + 1, y));
    const int low = std::min({here, before, after});
    const int high = std::max({here, before, after});
    return std::max({0, value - high, low - value});
  }

  int OutsideCost() const {
    if (s_.outside_cost >= 0) return s_.outside_cost;
    if (s_.cost == MatchCost::kSad || s_.cost == MatchCost::kBirchfieldTomasi) {
      return (s_.grey_limit + 4) / 10;
    }
    const int census = s_.census == CensusPattern::k9x7 ? 9 : 7;
    return s_.cost == MatchCost::kCensus ? census : census + (s_.ad_limit + 1) / 2;
  }

  int PixelCost(int x, int y, int i) const {
    if (!Inside(x, i)) return OutsideCost();
    const int xr = x - s_.min_disparity - i;
    const int l = Input(left_, x, y);
    const int r = Input(right_, xr, y);
    switch (s_.cost) {
      case MatchCost::kSad:
        return std::min(std::abs(l - r), s_.grey_limit);
      case MatchCost::kBirchfieldTomasi:
        return std::min({Outside(l, right_, xr, y), Outside(r, left_, x, y), s_.grey_limit});
      case MatchCost::kCensus:
        return CensusDistance(x, xr, y);
      default:
        return CensusDistance(x, xr, y) +
               std::min(std::abs((l + 2) / 4 - (r + 2) / 4), s_.ad_limit);
    }
  }

  std::vector<int> WindowCosts() const {
    std::vector<int> pixel(static_cast<size_t>(width_) * height_ * count_);
    ForEachCell([&](int x, int y, int i) { pixel[Cell(x, y, i)] = PixelCost(x, y, i); });
    const int m = s_.window_width;
    const int n = s_.window_height;
    std::vector<int> window = pixel;
    ForEachCell([&](int x, int y, int i) {
      if (!Inside(x, i)) return;
      int sum = 0;
      for (int v = y - n / 2; v < y - n / 2 + n; ++v) {
        for (int u = x - m / 2; u < x - m / 2 + m; ++u) {
          sum += pixel[Cell(std::clamp(u, 0, width_ - 1), std::clamp(v, 0, height_ - 1), i)];
        }
      }
      window[Cell(x, y, i)] = (sum + m * n / 2) / (m * n);
    });
    if (!s_.smooth_cost) return window;
    std::vector<int> across = window;
    ForEachCell([&](int x, int y, int i) {
      const auto cost = [&](int u) {
        return window[Cell(Alike(x, y, u, y, s_.smooth_cost_gate) ? u : x, y, i)];
      };
      across[Cell(x, y, i)] = Average(cost(x), Average(cost(x - 1), cost(x + 1)));
    });
    std::vector<int> smooth = window;
    ForEachCell([&](int x, int y, int i) {
      if (!Inside(x, i)) return;
      const auto cost = [&](int v) {
        return across[Cell(x, Alike(x, y, x, v, s_.smooth_cost_gate) ? v : y, i)];
      };
      smooth[Cell(x, y, i)] = Average(cost(y), Average(cost(y - 1), cost(y + 1)));
    });
    return smooth;
  }

  template <class Visit>
  void ForEachCell(Visit visit) const {
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        for (int i = 0; i < count_; ++i) visit(x, y, i);
      }
    }
  }

  bool InPicture(int x, int y) const { return x >= 0 && x < width_ && y >= 0 && y < height_; }
  bool Alike(int x, int y, int u, int v, int gate) const {
    return InPicture(u, v) && std::abs(left_.Row(y)[x] - left_.Row(v)[u]) <= gate;
  }

  // Of all paths, one pixel after the other, by recursion to the start of its line; the usual form
  // without normalising, L = C + min(...) - M.
  void SumPaths() {
    constexpr int kOrder[8][2] = {{1, 0}, {-1, 0}, {0, 1},   {0, -1},
                                  {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    sums_.assign(costs_.size(), 0);
    for (int k = 0; k < s_.directions; ++k) {
      const int dx = kOrder[k][0];
      const int dy = kOrder[k][1];
      for (int y = 0; y < height_; ++y) {
        for (int x = 0; x < width_; ++x) {
          if (InPicture(x - dx, y - dy)) continue;
          FollowLine(x, y, dx, dy);
        }
      }
    }
    for (int& sum : sums_) sum = std::min(sum, 255);
  }

  void FollowLine(int x, int y, int dx, int dy) {
    std::vector<int> before;
    for (; InPicture(x, y); x += dx, y += dy) {
      std::vector<int> path(static_cast<size_t>(count_));
      for (int i = 0; i < count_; ++i) {
        path[i] = costs_[Cell(x, y, i)];
        if (!before.empty()) path[i] += Transition(before, i, P2(x, y, x - dx, y - dy));
      }
      const int least = *std::min_element(path.begin(), path.end());
      for (int i = 0; i < count_; ++i) sums_[Cell(x, y, i)] += path[i] - least;
      before = path;
    }
  }

  int Transition(const std::vector<int>& before, int i, int p2) const {
    const int least = *std::min_element(before.begin(), before.end());
    int best = std::min(before[i], least + p2);
    if (i > 0) best = std::min(best, before[i - 1] + s_.p1);
    if (i + 1 < count_) best = std::min(best, before[i + 1] + s_.p1);
    return best - least;
  }

  int P2(int x, int y, int u, int v) const {
    const int step = std::abs(left_.Row(y)[x] - left_.Row(v)[u]);
    const double falling = s_.p2 / (1 + s_.p2_slope_permille / 1000.0 * step);
    // A hair up, because a tie at one half comes out of the division a little low or high.
    const int rounded = static_cast<int>(std::floor(falling + 0.5 + 1e-9));
    return std::max({rounded, std::min(s_.p2, s_.p2_min), s_.p1});
  }

  int Sum(int x, int y, int i) const { return sums_[Cell(x, y, i)]; }

  int LeftWinner(int x, int y) const {
    int best = 0;
    for (int i = 1; i < count_; ++i) {
      if (Sum(x, y, i) < Sum(x, y, best)) best = i;
    }
    return best;
  }

  int RightWinner(int xr, int y) const {
    int best = 0;
    int least = 255;
    for (int i = 0; i < count_; ++i) {
      const int x = xr + s_.min_disparity + i;
      if (x < 0 || x >= width_ || Sum(x, y, i) >= least) continue;
      least = Sum(x, y, i);
      best = i;
    }
    return best;
  }

  void Select() {
    pixels_.assign(static_cast<size_t>(width_) * height_, {});
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) At(x, y) = SelectPixel(x, y);
    }
  }

  int SubPixel(int x, int y, int i) const {
    if (i == 0 || i == count_ - 1 || s_.sub_pixel == SubPixel::kOff) return 0;
    const double before = Sum(x, y, i - 1);
    const double best = Sum(x, y, i);
    const double after = Sum(x, y, i + 1);
    const double divisor = s_.sub_pixel == SubPixel::kParabola ? before + after - 2 * best
                                                               : std::max(before, after) - best;
    if (divisor == 0) return 0;
    return static_cast<int>(std::floor(8 * (before - after) / divisor + 0.5 + 1e-9));
  }

  Pixel SelectPixel(int x, int y) const {
    const int i = LeftWinner(x, y);
    const int best = Sum(x, y, i);
    int second = 255;
    for (int k = 0; k < count_; ++k) {
      if (std::abs(k - i) > 1) second = std::min(second, Sum(x, y, k));
    }
    const int offset = s_.min_disparity < 0 ? s_.min_disparity - 1 : 0;
    const int stored = 16 * (s_.min_disparity + i - offset) + SubPixel(x, y, i);
    int difference = 0;
    if (s_.left_right_check && Inside(x, i)) {
      const int counterpart = x - s_.min_disparity - i;
      difference = std::abs(RightWinner(counterpart, y) - i);
      if (s_.left_right_lenient && counterpart > 0) {
        difference = std::min(difference, std::abs(RightWinner(counterpart - 1, y) - i));
      }
    }
    int confidence = second == 0 ? 0 : 255 * (second - best) / second;
    for (int k = 0; k < difference; ++k) confidence /= 2;
    confidence = std::max(confidence, 2);
    const auto invalid = [](InvalidReason reason) { return Pixel{0, 0, reason}; };
    if (!Inside(x, i)) return invalid(InvalidReason::kBorder);
    if (stored <= 0) return invalid(InvalidReason::kOutOfRangeFar);
    if (difference > s_.left_right_tolerance) {
      if (i == 0) return invalid(InvalidReason::kOutOfRangeFar);
      if (i == count_ - 1) return invalid(InvalidReason::kOutOfRangeNear);
      return invalid(Explain(InvalidReason::kOccluded, x, y));
    }
    if (second * (100 - s_.uniqueness_percent) < best * 100) {
      return invalid(Explain(InvalidReason::kAmbiguous, x, y));
    }
    if (confidence < s_.min_confidence) return invalid(InvalidReason::kFiltered);
    return {stored, confidence, InvalidReason::kNone};
  }

  InvalidReason Explain(InvalidReason reason, int x, int y) const {
    const int grey = left_.Row(y)[x];
    if (grey >= 254) return InvalidReason::kSaturated;
    if (grey <= 3) return InvalidReason::kDark;
    int low = grey;
    int high = grey;
    for (int v = y - 2; v <= y + 2; ++v) {
      for (int u = x - 2; u <= x + 2; ++u) {
        if (!InPicture(u, v)) continue;
        low = std::min<int>(low, left_.Row(v)[u]);
        high = std::max<int>(high, left_.Row(v)[u]);
      }
    }
    return high - low < 8 ? InvalidReason::kLowTexture : reason;
  }

  void Median() {
    const std::vector<Pixel> in = pixels_;
    const int r = s_.median / 2;
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        std::vector<int> values;
        for (int v = y - r; v <= y + r; ++v) {
          for (int u = x - r; u <= x + r; ++u) {
            const int row = std::clamp(v, 0, height_ - 1);
            values.push_back(
                in[static_cast<size_t>(row) * width_ + std::clamp(u, 0, width_ - 1)].stored);
          }
        }
        std::sort(values.begin(), values.end());
        Pixel& pixel = At(x, y);
        const bool was_valid = pixel.stored != 0;
        pixel.stored = values[values.size() / 2];
        if (was_valid && pixel.stored == 0) pixel = {0, 0, InvalidReason::kFiltered};
        if (!was_valid && pixel.stored != 0) pixel = {pixel.stored, 1, InvalidReason::kNone};
      }
    }
  }

  void RemoveSpeckles() {
    std::vector<bool> seen(pixels_.size(), false);
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        if (At(x, y).stored == 0 || seen[static_cast<size_t>(y) * width_ + x]) continue;
        std::vector<Point> region = {{x, y}};
        seen[static_cast<size_t>(y) * width_ + x] = true;
        for (size_t k = 0; k < region.size(); ++k) {
          const auto [px, py] = region[k];
          for (const auto& [u, v] :
               {Point{px - 1, py}, Point{px + 1, py}, Point{px, py - 1}, Point{px, py + 1}}) {
            if (!InPicture(u, v) || At(u, v).stored == 0) continue;
            if (std::abs(At(u, v).stored - At(px, py).stored) > 16 * s_.speckle_step) continue;
            if (seen[static_cast<size_t>(v) * width_ + u]) continue;
            seen[static_cast<size_t>(v) * width_ + u] = true;
            region.emplace_back(u, v);
          }
        }
        if (static_cast<int>(region.size()) > s_.speckle_size) continue;
        // Only marked, for a removed region still separates its neighbours' regions as before.
        for (const auto& [u, v] : region) At(u, v).reason = InvalidReason::kSpeckle;
      }
    }
    for (Pixel& pixel : pixels_) {
      if (pixel.reason == InvalidReason::kSpeckle) pixel = {0, 0, InvalidReason::kSpeckle};
    }
  }

  // The median of the valid pixels alike in the window; nothing if there are fewer than `least`
  // or less than `agreeing` percent of them lie within 1 px of it.
  std::optional<int> GatedMedian(const std::vector<Pixel>& in, int x, int y, int radius, int least,
                                 int agreeing) const {
    std::vector<int> values;
    for (int v = y - radius; v <= y + radius; ++v) {
      for (int u = x - radius; u <= x + radius; ++u) {
        if (!Alike(x, y, u, v, s_.gate)) continue;
        const int stored = in[static_cast<size_t>(v) * width_ + u].stored;
        if (stored != 0) values.push_back(stored);
      }
    }
    if (static_cast<int>(values.size()) < least) return std::nullopt;
    std::sort(values.begin(), values.end());
    const int median = values[values.size() / 2];
    int near = 0;
    for (const int value : values) near += std::abs(value - median) <= 16 ? 1 : 0;
    if (100 * near < agreeing * static_cast<int>(values.size())) return std::nullopt;
    return median;
  }

  void GatedFilters() {
    const std::vector<Pixel> in = pixels_;
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        Pixel& pixel = At(x, y);
        if (pixel.stored != 0) {
          if (s_.gated_median) pixel.stored = *GatedMedian(in, x, y, 2, 1, 0);
        } else if (s_.fill_holes) {
          const std::optional<int> fill = GatedMedian(in, x, y, 3, 12, 70);
          if (fill) pixel = {*fill, 1, InvalidReason::kNone};
        }
      }
    }
  }

  void FillBackground() {
    const std::vector<Pixel> in = pixels_;
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        if (At(x, y).stored != 0) continue;
        int fill = 0;
        for (const int step : {-1, 1}) {
          int u = x;
          while (u >= 0 && u < width_ && in[static_cast<size_t>(y) * width_ + u].stored == 0)
            u += step;
          if (u < 0 || u >= width_) continue;
          const int found = in[static_cast<size_t>(y) * width_ + u].stored;
          fill = fill == 0 ? found : std::min(fill, found);
        }
        if (fill != 0) At(x, y) = {fill, 1, InvalidReason::kNone};
      }
    }
  }

  Pixel& At(int x, int y) { return pixels_[static_cast<size_t>(y) * width_ + x]; }

  const GreyImage& left_;
  const GreyImage& right_;
  const SgmSettings& s_;
  const int width_;
  const int height_;
  const int count_;
  std::vector<int> costs_;
  std::vector<int> sums_;
  std::vector<Pixel> pixels_;
};

}  // namespace

DisparityMap NaiveSgm(const GreyImage& left, const GreyImage& right, const SgmSettings& settings,
                      BufferPool& pool) {
  const PicturePair pair = ConditionPair(left, right, settings, pool);
  return Naive(pair.left, pair.right, settings).Run(pool);
}

}  // namespace vs
