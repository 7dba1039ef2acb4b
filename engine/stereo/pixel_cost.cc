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
  const auto width = static_cast<size_t>(width_);
  for (View* view : {&left_, &right_}) {
    view->grey.resize(width);
    view->low.resize(settings.cost == MatchCost::kBirchfieldTomasi ? width : 0);
    view->high.resize(view->low.size());
    view->codes.resize(UsesCensus(settings.cost) ? width * CensusBytes(settings.census) : 0);
  }
}

void PixelCost::PrepareRow(const PaddedPicture& picture, int y, View* view) const {
  const uint8_t* row = picture.Row(y);
  for (int x = 0; x < width_; ++x) {
    view->grey[x] =
        settings_.cost == MatchCost::kAdCensus ? static_cast<uint8_t>((row[x] + 2) >> 2) : row[x];
  }
  if (settings_.cost == MatchCost::kBirchfieldTomasi) {
    for (int x = 0; x < width_; ++x) {
      const uint8_t before = Average(row[x], row[x - 1]);
      const uint8_t after = Average(row[x], row[x + 1]);
      view->low[x] = std::min(row[x], std::min(before, after));
      view->high[x] = std::max(row[x], std::max(before, after));
    }
  }
  if (UsesCensus(settings_.cost)) CensusRow(picture, settings_.census, y, view->codes.data());
}

void PixelCost::Row(int y, uint8_t* cost) {
  PrepareRow(*left_picture_, y, &left_);
  PrepareRow(*right_picture_, y, &right_);
  for (auto* rows : {&right_.grey, &right_.low, &right_.high, &right_.codes}) {
    MirrorRows(rows->data(), width_, static_cast<int>(rows->size() / static_cast<size_t>(width_)));
  }
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
  const uint8_t* right = right_.grey.data() + mirrored;
  const auto grey_limit = static_cast<uint8_t>(settings_.grey_limit);
  switch (settings_.cost) {
    case MatchCost::kSad:
      return SadCost(left_.grey[x], right, count, grey_limit, cost);
    case MatchCost::kBirchfieldTomasi:
      return BirchfieldTomasiCost({left_.grey[x], left_.low[x], left_.high[x]}, right,
                                  right_.low.data() + mirrored, right_.high.data() + mirrored,
                                  count, grey_limit, cost);
    case MatchCost::kCensus:
    case MatchCost::kAdCensus:
      break;
  }
  const auto stride = static_cast<size_t>(width_);
  const uint8_t* left_code = left_.codes.data() + x;
  const uint8_t* right_codes = right_.codes.data() + mirrored;
  const int shift = CensusShift(settings_.census);
  switch (CensusBytes(settings_.census)) {
    case 6:
      CensusCost<6>(left_code, right_codes, stride, count, shift, cost);
      break;
    case 8:
      CensusCost<8>(left_code, right_codes, stride, count, shift, cost);
      break;
    default:
      CensusCost<3>(left_code, right_codes, stride, count, shift, cost);
      break;
  }
  if (settings_.cost == MatchCost::kAdCensus && settings_.ad_limit > 0) {
    AddDifference(left_.grey[x], right, count, static_cast<uint8_t>(settings_.ad_limit), cost);
  }
}

}  // namespace vs
