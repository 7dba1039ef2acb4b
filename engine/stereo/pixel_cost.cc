#include "engine/stereo/pixel_cost.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "engine/stereo/census.h"

namespace vs {
namespace {

bool UsesCensus(MatchCost cost) {
  return cost == MatchCost::kCensus || cost == MatchCost::kAdCensus;
}

uint8_t AbsoluteDifference(uint8_t a, uint8_t b) {
  return static_cast<uint8_t>(a > b ? a - b : b - a);
}

uint8_t Average(uint8_t a, uint8_t b) { return static_cast<uint8_t>((a + b + 1) >> 1); }

// a - b, or 0 where that is negative.
uint8_t Excess(uint8_t a, uint8_t b) { return static_cast<uint8_t>(a > b ? a - b : 0); }

uint8_t BitCount(uint8_t v) {
  v = static_cast<uint8_t>(v - ((v >> 1) & 0x55));
  v = static_cast<uint8_t>((v & 0x33) + ((v >> 2) & 0x33));
  return static_cast<uint8_t>((v + (v >> 4)) & 0x0f);
}

void SadCost(uint8_t left, const uint8_t* __restrict right, int count, uint8_t limit,
             uint8_t* __restrict cost) {
  for (int i = 0; i < count; ++i) {
    cost[i] = std::min(AbsoluteDifference(left, right[i]), limit);
  }
}

void AddDifference(uint8_t left, const uint8_t* __restrict right, int count, uint8_t limit,
                   uint8_t* __restrict cost) {
  for (int i = 0; i < count; ++i) {
    cost[i] = static_cast<uint8_t>(cost[i] + std::min(AbsoluteDifference(left, right[i]), limit));
  }
}

struct Sampled {
  uint8_t value, low, high;
};

void BirchfieldTomasiCost(Sampled left, const uint8_t* __restrict right,
                          const uint8_t* __restrict right_low, const uint8_t* __restrict right_high,
                          int count, uint8_t limit, uint8_t* __restrict cost) {
  for (int i = 0; i < count; ++i) {
    const uint8_t a = std::max(Excess(left.value, right_high[i]), Excess(right_low[i], left.value));
    const uint8_t b = std::max(Excess(right[i], left.high), Excess(left.low, right[i]));
    cost[i] = std::min(std::min(a, b), limit);
  }
}

// Bytes and stride of the codes: byte b of entry i is codes[b * stride + i].
template <int kBytes>
void CensusCost(const uint8_t* left, const uint8_t* right, size_t stride, int count, int shift,
                uint8_t* __restrict cost) {
  uint8_t code[kBytes];
  for (int b = 0; b < kBytes; ++b) code[b] = left[static_cast<size_t>(b) * stride];
  for (int i = 0; i < count; ++i) {
    uint8_t distance = 0;
    for (int b = 0; b < kBytes; ++b) {
      const auto different = static_cast<uint8_t>(code[b] ^ right[b * stride + i]);
      distance = static_cast<uint8_t>(distance + BitCount(different));
    }
    cost[i] = distance;
  }
  if (shift == 0) return;
  for (int i = 0; i < count; ++i) cost[i] = static_cast<uint8_t>((cost[i] + 1) >> 1);
}

void MirrorRows(uint8_t* rows, int width, int count) {
  for (int r = 0; r < count; ++r) {
    uint8_t* row = rows + static_cast<size_t>(r) * width;
    std::reverse(row, row + width);
  }
}

}  // namespace

int OutsideCost(const SgmSettings& settings) {
  if (settings.outside_cost != SgmSettings::kAutomatic) return settings.outside_cost;
  switch (settings.cost) {
    case MatchCost::kCensus:
    case MatchCost::kAdCensus: {
      const int census = settings.census == CensusPattern::k9x7 ? 9 : 7;
      return census + (settings.cost == MatchCost::kAdCensus ? (settings.ad_limit + 1) / 2 : 0);
    }
    default:
      return (settings.grey_limit + 4) / 10;
  }
}

int FeaturePlanes(const SgmSettings& settings) {
  switch (settings.cost) {
    case MatchCost::kSad:
      return 1;
    case MatchCost::kBirchfieldTomasi:
      return 3;
    case MatchCost::kCensus:
      return CensusBytes(settings.census);
    case MatchCost::kAdCensus:
      break;
  }
  return CensusBytes(settings.census) + 1;
}

void CoarseGreyRow(const PaddedPicture& picture, int y, uint8_t* out) {
  const uint8_t* row = picture.Row(y);
  const int width = picture.width();
  for (int x = 0; x < width; ++x) out[x] = static_cast<uint8_t>((row[x] + 2) >> 2);
}

void FeatureRow(const PaddedPicture& picture, const SgmSettings& settings, int y, uint8_t* planes) {
  const uint8_t* row = picture.Row(y);
  const int width = picture.width();
  if (UsesCensus(settings.cost)) {
    CensusRow(picture, settings.census, y, planes);
    if (settings.cost == MatchCost::kCensus) return;
    CoarseGreyRow(picture, y, planes + static_cast<size_t>(CensusBytes(settings.census)) * width);
    return;
  }
  std::memcpy(planes, row, static_cast<size_t>(width));
  if (settings.cost == MatchCost::kSad) return;
  uint8_t* low = planes + width;
  uint8_t* high = low + width;
  for (int x = 0; x < width; ++x) {
    const uint8_t before = Average(row[x], row[x - 1]);
    const uint8_t after = Average(row[x], row[x + 1]);
    low[x] = std::min(row[x], std::min(before, after));
    high[x] = std::max(row[x], std::max(before, after));
  }
}

InsideRange InsideOf(int x, int width, const SgmSettings& settings) {
  // 0 <= x - min_disparity - i < width
  const int begin = std::clamp(x - settings.min_disparity - width + 1, 0, settings.num_disparities);
  const int end = std::clamp(x - settings.min_disparity + 1, begin, settings.num_disparities);
  return {begin, end};
}

void PixelCost::Prepare(const PaddedPicture* left, const PaddedPicture* right,
                        const SgmSettings& settings) {
  left_picture_ = left;
  right_picture_ = right;
  settings_ = settings;
  width_ = left->width();
  planes_ = FeaturePlanes(settings);
  left_.resize(static_cast<size_t>(width_) * planes_);
  right_.resize(left_.size());
}

void PixelCost::Row(int y, uint8_t* cost) {
  FeatureRow(*left_picture_, settings_, y, left_.data());
  FeatureRow(*right_picture_, settings_, y, right_.data());
  MirrorRows(right_.data(), width_, planes_);
  const int disparities = settings_.num_disparities;
  const int outside = OutsideCost(settings_);
  for (int x = 0; x < width_; ++x, cost += disparities) {
    const InsideRange inside = InsideOf(x, width_, settings_);
    std::memset(cost, outside, static_cast<size_t>(inside.begin));
    std::memset(cost + inside.end, outside, static_cast<size_t>(disparities - inside.end));
    const int mirrored = width_ - 1 - x + settings_.min_disparity + inside.begin;
    if (inside.begin < inside.end) Compare(x, inside.begin, inside.end, mirrored, cost);
  }
}

void PixelCost::Compare(int x, int begin, int end, int mirrored, uint8_t* cost) const {
  const int count = end - begin;
  cost += begin;
  const auto stride = static_cast<size_t>(width_);
  const uint8_t* left = left_.data() + x;
  const uint8_t* right = right_.data() + mirrored;
  const auto grey_limit = static_cast<uint8_t>(settings_.grey_limit);
  if (settings_.cost == MatchCost::kSad) return SadCost(*left, right, count, grey_limit, cost);
  if (settings_.cost == MatchCost::kBirchfieldTomasi) {
    return BirchfieldTomasiCost({left[0], left[stride], left[2 * stride]}, right, right + stride,
                                right + 2 * stride, count, grey_limit, cost);
  }
  const int bytes = CensusBytes(settings_.census);
  const int shift = CensusShift(settings_.census);
  switch (bytes) {
    case 6:
      CensusCost<6>(left, right, stride, count, shift, cost);
      break;
    case 8:
      CensusCost<8>(left, right, stride, count, shift, cost);
      break;
    default:
      CensusCost<3>(left, right, stride, count, shift, cost);
      break;
  }
  if (settings_.cost == MatchCost::kAdCensus) {
    AddDifference(left[bytes * stride], right + bytes * stride, count,
                  static_cast<uint8_t>(settings_.ad_limit), cost);
  }
}

}  // namespace vs
