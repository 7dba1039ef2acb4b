#include "engine/stereo/condition_pair.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

namespace vs {
namespace {

constexpr int kBlock = 8;
// So many blocks tell enough of a picture.
constexpr int kBlocks = 1024;
// Noise is cut off at the ends of the grey scale.
constexpr int kLeastGrey = 6;
constexpr int kGreatestGrey = 249;
constexpr int kQuantiles = 19;
// A smaller mean difference may be the scene's: the two cameras do not see the same. Sixteenths of
// a grey level.
constexpr int kLeastGreyDifference = 5 * 16;

// Noise from which on smoothing gains more than it loses, sixteenths of a grey level.
constexpr int kStrongBlurFrom = 29;

// Weights of a pixel's neighbour and of itself, of 256: a Gaussian of sigma 0.5 and 0.7 px.
struct BlurWeights {
  uint16_t side;
  uint16_t centre;
};
constexpr BlurWeights kLight = {27, 202};
constexpr BlurWeights kStrong = {54, 148};

// A row of a block.
using BlockRow = int16_t __attribute__((vector_size(2 * kBlock)));

BlockRow LoadBlockRow(const uint8_t* from) {
  uint8_t __attribute__((vector_size(kBlock))) greys;
  std::memcpy(&greys, from, sizeof greys);
  return __builtin_convertvector(greys, BlockRow);
}

// Mask response of one block; negative if the block's greys reach an end of the scale.
int BlockResponse(const GreyImage& picture, int x0, int y0) {
  BlockRow sums = {};  // at most 8 * 8 * 255 each
  BlockRow low = BlockRow{} + 255;
  BlockRow high = {};
  for (int y = y0; y < y0 + kBlock; ++y) {
    const uint8_t* above = picture.Row(y - 1) + x0;
    const uint8_t* row = picture.Row(y) + x0;
    const uint8_t* below = picture.Row(y + 1) + x0;
    const BlockRow corners = LoadBlockRow(above - 1) + LoadBlockRow(above + 1) +
                             LoadBlockRow(below - 1) + LoadBlockRow(below + 1);
    const BlockRow sides =
        LoadBlockRow(above) + LoadBlockRow(below) + LoadBlockRow(row - 1) + LoadBlockRow(row + 1);
    const BlockRow centre = LoadBlockRow(row);
    const BlockRow response = corners - 2 * sides + 4 * centre;
    sums += response < 0 ? -response : response;
    low = centre < low ? centre : low;
    high = centre > high ? centre : high;
  }
  int sum = 0;
  bool clipped = false;
  for (int k = 0; k < kBlock; ++k) {
    sum += sums[k];
    clipped |= low[k] < kLeastGrey || high[k] > kGreatestGrey;
  }
  return clipped ? -1 : sum;
}

// One output pixel is (side * (a + c) + centre * b) / 256 of three neighbours.
void BlurSpan(const uint8_t* a, const uint8_t* b, const uint8_t* c, int count, BlurWeights weights,
              uint8_t* __restrict out) {
  for (int x = 0; x < count; ++x) {
    const auto sides = static_cast<uint16_t>(a[x] + c[x]);
    out[x] = static_cast<uint8_t>(
        static_cast<uint16_t>(weights.side * sides + weights.centre * b[x] + 128) >> 8);
  }
}

// The rows beyond the border are the border's. `across` is room to work in.
void Blur(const GreyImage& picture, BlurWeights weights, GreyImage* across, GreyImage* out) {
  const int width = picture.width();
  const int height = picture.height();
  for (int y = 0; y < height; ++y) {
    const uint8_t* row = picture.Row(y);
    uint8_t* to = across->Row(y);
    BlurSpan(row, row, row + 1, 1, weights, to);
    BlurSpan(row, row + 1, row + 2, width - 2, weights, to + 1);
    BlurSpan(row + width - 2, row + width - 1, row + width - 1, 1, weights, to + width - 1);
  }
  for (int y = 0; y < height; ++y) {
    BlurSpan(across->Row(std::max(y - 1, 0)), across->Row(y),
             across->Row(std::min(y + 1, height - 1)), width, weights, out->Row(y));
  }
}

// Quantiles of the greys in columns [begin, end), in sixteenths of a grey level.
using Quantiles = std::array<int, kQuantiles>;
Quantiles QuantilesOf(const GreyImage& picture, int begin, int end) {
  // Neighbours, often of one grey, are counted apart: one count would wait for the other.
  constexpr int kCounters = 4;
  uint32_t counters[kCounters][256] = {};
  for (int y = 0; y < picture.height(); ++y) {
    const uint8_t* row = picture.Row(y);
    int x = begin;
    for (; x + kCounters <= end; x += kCounters) {
      for (int k = 0; k < kCounters; ++k) ++counters[k][row[x + k]];
    }
    for (; x < end; ++x) ++counters[0][row[x]];
  }
  std::array<int64_t, 256> counts = {};
  for (const auto& counter : counters) {
    for (int grey = 0; grey < 256; ++grey) counts[grey] += counter[grey];
  }
  const int64_t pixels = static_cast<int64_t>(end - begin) * picture.height();
  Quantiles quantiles = {};
  int64_t below = 0;
  int grey = 0;
  for (int k = 0; k < kQuantiles; ++k) {
    const int64_t wanted = pixels * (k + 1) / (kQuantiles + 1);
    while (below + counts[grey] < wanted) below += counts[grey++];
    const int64_t part = counts[grey] == 0 ? 0 : 16 * (wanted - below) / counts[grey];
    quantiles[k] = 16 * grey - 8 + static_cast<int>(part);
  }
  return quantiles;
}

struct Columns {
  int begin;
  int end;
};

// Those of one picture that show the same part of the scene as the other, if it lies at the middle
// of the range.
Columns CommonColumns(int width, const SgmSettings& settings, bool of_right) {
  const int middle = settings.min_disparity + settings.num_disparities / 2;
  const int shift = std::abs(middle) <= width / 2 ? middle : 0;
  const int from_left = std::max(of_right ? -shift : shift, 0);
  const int from_right = std::max(of_right ? shift : -shift, 0);
  return {from_left, width - from_right};
}

GreyMap MapBetween(const Quantiles& l, const Quantiles& r) {
  int64_t sum_l = 0;
  int64_t sum_r = 0;
  int64_t sum_rr = 0;
  int64_t sum_lr = 0;
  int64_t difference = 0;
  for (int k = 0; k < kQuantiles; ++k) {
    sum_l += l[k];
    sum_r += r[k];
    sum_rr += int64_t{r[k]} * r[k];
    sum_lr += int64_t{l[k]} * r[k];
    difference += std::abs(l[k] - r[k]);
  }
  if (difference < int64_t{kQuantiles} * kLeastGreyDifference) return {};
  const int64_t spread = kQuantiles * sum_rr - sum_r * sum_r;
  // A standard deviation of less than 4 grey levels.
  if (spread < int64_t{kQuantiles} * kQuantiles * 64 * 64) return {};
  const int64_t gain = GreyMap::kOne * (kQuantiles * sum_lr - sum_l * sum_r) / spread;
  if (gain < GreyMap::kOne / 2 || gain > int64_t{GreyMap::kOne} * 2) return {};
  const int64_t offset = (GreyMap::kOne * sum_l - gain * sum_r) / (int64_t{kQuantiles} * 16);
  return {static_cast<int>(gain), static_cast<int>(offset)};
}

GreyImage Mapped(const GreyImage& picture, const GreyMap& map, BufferPool& pool) {
  std::array<uint8_t, 256> table;
  for (int grey = 0; grey < 256; ++grey) {
    const int mapped = (map.gain * grey + map.offset + GreyMap::kOne / 2) >> 12;
    table[grey] = static_cast<uint8_t>(std::clamp(mapped, 0, 255));
  }
  GreyImage out(pool, picture.width(), picture.height());
  for (int y = 0; y < picture.height(); ++y) {
    const uint8_t* row = picture.Row(y);
    uint8_t* to = out.Row(y);
    for (int x = 0; x < picture.width(); ++x) to[x] = table[row[x]];
  }
  return out;
}

}  // namespace

int NoiseSixteenths(const GreyImage& picture) {
  const int columns = (picture.width() - 2) / kBlock;
  const int rows = (picture.height() - 2) / kBlock;
  const int step = std::max(columns * rows / kBlocks, 1);
  constexpr int kBin = 4;
  std::array<int, 1024> counts = {};
  int blocks = 0;
  for (int k = 0; k < columns * rows; k += step) {
    const int response = BlockResponse(picture, 1 + k % columns * kBlock, 1 + k / columns * kBlock);
    if (response < 0) continue;
    ++counts[std::min(response / kBin, 1023)];
    ++blocks;
  }
  if (blocks == 0) return 0;
  int bin = 0;
  for (int below = counts[0]; below * 20 < blocks; below += counts[bin]) ++bin;
  // For normally distributed noise of deviation s the mean response is 6 s sqrt(2 / pi); the 5 %
  // blocks have 0.77 of it (measured).
  return bin * kBin * 16 * 100 / (kBlock * kBlock * 479 * 77 / 100);
}

GreyMap MatchGreys(const GreyImage& left, const GreyImage& right, const SgmSettings& settings) {
  const Columns l = CommonColumns(left.width(), settings, false);
  const Columns r = CommonColumns(left.width(), settings, true);
  return MapBetween(QuantilesOf(left, l.begin, l.end), QuantilesOf(right, r.begin, r.end));
}

PicturePair ConditionPair(const GreyImage& left, const GreyImage& right,
                          const SgmSettings& settings, int parts, ThreadTeam* team,
                          BufferPool& pool) {
  PicturePair pair = {left, right};
  GreyImage* const pictures[] = {&pair.left, &pair.right};
  const auto each = [&](const auto& work) {
    const int threads = std::min(parts, 2);
    team->Run(threads, [&](int part) {
      for (int which = part; which < 2; which += threads) work(which);
    });
  };
  const bool measures_noise = settings.pre_blur == PreBlur::kAutomatic;
  int noise[2] = {};
  Quantiles quantiles[2] = {};
  if (measures_noise || settings.match_gain) {
    each([&](int which) {
      if (measures_noise) noise[which] = NoiseSixteenths(*pictures[which]);
      if (settings.match_gain) {
        const Columns columns = CommonColumns(left.width(), settings, which == 1);
        quantiles[which] = QuantilesOf(*pictures[which], columns.begin, columns.end);
      }
    });
  }
  if (settings.match_gain) {
    const GreyMap map = MapBetween(quantiles[0], quantiles[1]);
    if (map != GreyMap{}) pair.right = Mapped(right, map, pool);
  }
  PreBlur blur = settings.pre_blur;
  if (measures_noise) {  // before the gain, which amplifies the noise of one picture
    const bool strong = std::max(noise[0], noise[1]) >= kStrongBlurFrom;
    blur = strong ? PreBlur::kStrong : PreBlur::kOff;
  }
  if (blur != PreBlur::kOff) {
    const BlurWeights weights = blur == PreBlur::kLight ? kLight : kStrong;
    const PicturePair sharp = pair;
    const GreyImage* const from[] = {&sharp.left, &sharp.right};
    GreyImage across[2];
    for (int which = 0; which < 2; ++which) {  // here, where it may throw
      across[which] = GreyImage(pool, left.width(), left.height());
      *pictures[which] = GreyImage(pool, left.width(), left.height());
    }
    each([&](int which) { Blur(*from[which], weights, &across[which], pictures[which]); });
  }
  return pair;
}

PicturePair ConditionPair(const GreyImage& left, const GreyImage& right,
                          const SgmSettings& settings, BufferPool& pool) {
  ThreadTeam alone;
  return ConditionPair(left, right, settings, 1, &alone, pool);
}

}  // namespace vs
