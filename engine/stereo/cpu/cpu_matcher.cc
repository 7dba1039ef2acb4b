// The matcher for processors with vector instructions: what the reference matcher computes, bit for
// bit, in the order in which a processor likes it.
//
// Costs are made row by row where they are needed and never stored. Two sweeps, one from the top
// left and one from the bottom right, each add up to four directions as they pass; each stores its
// sums for the half of the picture that it comes through first. Then the sweeps go on into each
// other's half and finish it: they add what is stored there and select the winners at once. So the
// sums, a byte for each pixel and disparity, are the only large memory, written once and read once.
#include "engine/stereo/cpu/cpu_matcher.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include "engine/base/str.h"
#include "engine/stereo/cell_memory.h"
#include "engine/stereo/census.h"
#include "engine/stereo/condition_pair.h"
#include "engine/stereo/cpu/kernels.h"
#include "engine/stereo/cpu/sweep.h"
#include "engine/stereo/padded_picture.h"
#include "engine/stereo/path_cost.h"
#include "engine/stereo/pixel_cost.h"
#include "engine/stereo/refine.h"
#include "engine/stereo/selection.h"
#include "engine/stereo/stereo_matcher.h"
#include "engine/stereo/thread_team.h"

namespace vs::cpu {
namespace {

// Fewer columns for a thread are not worth the waiting.
constexpr int kLeastColumns = 16;

CostKind KindOf(const SgmSettings& settings) {
  if (settings.cost == MatchCost::kSad) return CostKind::kSad;
  if (settings.cost == MatchCost::kBirchfieldTomasi) return CostKind::kBirchfieldTomasi;
  const bool ad = settings.cost == MatchCost::kAdCensus;
  switch (CensusBytes(settings.census)) {
    case 6:
      return ad ? CostKind::kAdCensus6 : CostKind::kCensus6;
    case 8:
      return ad ? CostKind::kAdCensus8 : CostKind::kCensus8;
    default:
      return ad ? CostKind::kAdCensus3 : CostKind::kCensus3;
  }
}

// How many of the first `directions` of kDirections each sweep takes.
struct Shares {
  int forward;
  int backward;
};
Shares SharesOf(int directions) {
  constexpr Shares kShares[] = {{1, 0}, {1, 1}, {2, 1}, {2, 2}, {3, 2}, {4, 2}, {4, 3}, {4, 4}};
  return kShares[directions - 1];
}

PenaltySteps StepsOf(const Penalties& penalties) {
  PenaltySteps steps{.penalty = penalties.p2[0]};
  for (int g = 1; g < 256; ++g) {
    for (int k = penalties.p2[g]; k < penalties.p2[g - 1]; ++k) {
      steps.limits[steps.count++] = static_cast<uint8_t>(g);
    }
  }
  return steps;
}

// Where all parts of a team wait for each other.
class MeetingPoint {
 public:
  void Reset(int parts) {
    parts_ = parts;
    arrived_ = 0;
  }
  void Wait() {
    const int round = arrived_.fetch_add(1, std::memory_order_acq_rel) / parts_;
    for (int looks = 0; arrived_.load(std::memory_order_acquire) < (round + 1) * parts_; ++looks) {
      if (looks > 1000) std::this_thread::yield();
    }
  }

 private:
  int parts_ = 1;
  std::atomic<int> arrived_ = 0;
};

class CpuMatcher final : public StereoMatcher {
 public:
  explicit CpuMatcher(const Kernels* kernels) : kernels_(kernels), refiner_(*kernels->filters) {}

  size_t WorkingBytes() const override {
    size_t bytes = left_features_.Bytes() + right_features_.Bytes() + sums_.Bytes() +
                   winners_.Bytes() + right_index_.Bytes();
    for (const auto& sweep : sweeps_) bytes += sweep->Bytes();
    return bytes;
  }

 private:
  Result<DisparityMap> MatchPair(const GreyImage& raw_left, const GreyImage& raw_right,
                                 const SgmSettings& settings, int threads,
                                 BufferPool& pool) override;
  Status Prepare(const GreyImage& left, const GreyImage& right, const SgmSettings& settings,
                 int parts);
  void MakeFeatures(const SgmSettings& settings, int part, RowRange rows);
  // FeatureRow of pixel_cost.h, faster.
  void FeatureRowOf(const PaddedPicture& picture, const SgmSettings& settings, int y,
                    uint8_t* planes) const;
  void RunSweeps(int directions, int part, int parts);

  WinnerRow WinnersOf(int y) {
    const int width = frame_.plan.width;
    return WinnerRow::In(frame_.winners + static_cast<size_t>(y) * WinnerRow::kPlanes * width,
                         width);
  }
  const uint8_t* RightIndexOf(int y) const {
    return frame_.right_index + static_cast<size_t>(y) * frame_.plan.width;
  }

  const Kernels* kernels_;
  ThreadTeam team_;
  MeetingPoint meeting_;
  PaddedPicture left_;
  PaddedPicture right_;
  PaddedPicture guide_;  // only if left_ is not the picture as the camera saw it
  SweepFrame frame_;
  std::vector<std::vector<uint8_t>> feature_rows_;  // by part; see Kernels::stripe_row
  std::vector<std::unique_ptr<Sweep>> sweeps_;
  CellMemory layout_;
  CellMemory left_features_;
  CellMemory right_features_;
  CellMemory sums_;
  CellMemory winners_;
  CellMemory right_index_;
  Refiner refiner_;
};

Result<DisparityMap> CpuMatcher::MatchPair(const GreyImage& raw_left, const GreyImage& raw_right,
                                           const SgmSettings& settings, int threads,
                                           BufferPool& pool) {
  const int parts = std::clamp(threads, 1, 2 * (raw_left.width() / kLeastColumns));
  const PicturePair pair = ConditionPair(raw_left, raw_right, settings, parts, &team_, pool);
  const GreyImage& left = pair.left;
  VS_RETURN_IF_ERROR(Prepare(left, pair.right, settings, parts));
  DisparityMap map = MakeDisparityMap(left.width(), left.height(), DisparityOffset(settings), pool);
  meeting_.Reset(parts);
  team_.Run(parts, [&](int part) {
    const RowRange rows = ShareOf(left.height(), part, parts);
    MakeFeatures(settings, part, rows);
    meeting_.Wait();
    RunSweeps(settings.directions, part, parts);
    meeting_.Wait();
    for (int y = rows.begin; y < rows.end; ++y) {
      JudgeRow(settings, left, y, WinnersOf(y), RightIndexOf(y), *kernels_->filters, &map);
    }
  });
  refiner_.Refine(left, settings, parts, &team_, pool, &map);
  return map;
}

Status CpuMatcher::Prepare(const GreyImage& left, const GreyImage& right,
                           const SgmSettings& settings, int parts) {
  const auto width = static_cast<size_t>(left.width());
  const auto height = static_cast<size_t>(left.height());
  Plan plan{.width = left.width(), .height = left.height()};
  plan.min_disparity = settings.min_disparity;
  plan.num_disparities = settings.num_disparities;
  plan.stripes = kernels_->stripes(settings.num_disparities);
  plan.cell = plan.stripes * kernels_->lanes;
  // Half a cell of room on both sides of a mirrored row, and what the last load reads beyond.
  const size_t right_row = (width + size_t{2} * plan.cell) / plan.stripes + 2;
  plan.right_stride = (right_row + kernels_->lanes + 63) / 64 * 64;
  plan.planes = FeaturePlanes(settings);
  const bool census = settings.cost == MatchCost::kAdCensus || settings.cost == MatchCost::kCensus;
  plan.limit = static_cast<uint8_t>(census ? settings.ad_limit : settings.grey_limit);
  plan.outside = static_cast<uint8_t>(OutsideCost(settings));
  plan.window_width = settings.window_width;
  plan.window_height = settings.window_height;
  plan.gate = settings.smooth_cost ? settings.smooth_cost_gate : -1;
  left_.Assign(left, settings.sobel_cap);
  right_.Assign(right, settings.sobel_cap);
  if (settings.sobel_cap > 0) guide_.Assign(left, 0);
  const PaddedPicture& guide = settings.sobel_cap > 0 ? guide_ : left_;
  plan.guide = guide.Row(0);
  plan.guide_stride = static_cast<size_t>(guide.Row(1) - guide.Row(0));
  plan.p1 = static_cast<uint8_t>(settings.p1);
  plan.right_view = settings.left_right_check;

  feature_rows_.resize(std::max(feature_rows_.size(), static_cast<size_t>(parts)));
  for (int part = 0; part < parts; ++part)
    feature_rows_[part].resize(kernels_->lanes + width * plan.planes);

  const Shares shares = SharesOf(settings.directions);
  const size_t sums = shares.backward == 0 ? 0 : width * height * plan.cell;
  const size_t right_features = height * plan.planes * plan.stripes * plan.right_stride;
  plan.left_features = left_features_.Reserve(width * height * plan.planes);
  plan.right_features = right_features_.Reserve(right_features);
  frame_ = {.kernels = kernels_, .plan = plan, .kind = KindOf(settings)};
  frame_.penalties = StepsOf(MakePenalties(settings));
  frame_.sums = sums_.Reserve(sums);
  if (layout_.Reserve(static_cast<size_t>(plan.cell) * kLayoutCells) != nullptr) {
    kernels_->layout(plan, layout_.Reserve(0));
    frame_.plan.layout = layout_.Reserve(0);
  }
  frame_.winners = winners_.Reserve(width * height * WinnerRow::kPlanes);
  frame_.right_index = right_index_.Reserve(width * height);
  bool enough = frame_.plan.layout != nullptr && plan.left_features != nullptr &&
                plan.right_features != nullptr && (sums == 0 || frame_.sums != nullptr) &&
                frame_.winners != nullptr && frame_.right_index != nullptr;

  // With one direction every part sweeps rows of its own; otherwise there are two sweeps, each by
  // half of the parts.
  const size_t count = shares.backward == 0 ? static_cast<size_t>(parts) : 2;
  const int blocks = shares.backward == 0 ? 1 : std::max(parts / 2, 1);
  while (sweeps_.size() < count) sweeps_.push_back(std::make_unique<Sweep>());
  for (size_t k = 0; k < count && enough; ++k) {
    const bool backward = shares.backward > 0 && k == 1;
    const int directions = backward ? shares.backward : shares.forward;
    enough = sweeps_[k]->Prepare(&frame_, directions, backward, blocks);
  }
  if (!enough) {
    return ResourceExhausted(Str("matcher: not enough memory for ", left.width(), " x ",
                                 left.height(), " px with ", settings.num_disparities,
                                 " disparities (", sums / 1000000,
                                 " MB and more); use smaller pictures or a smaller range"));
  }
  return Status();
}

void CpuMatcher::MakeFeatures(const SgmSettings& settings, int part, RowRange rows) {
  const Plan plan = frame_.plan;  // a copy that no byte that is stored could change
  const auto width = static_cast<size_t>(plan.width);
  uint8_t* const right = feature_rows_[part].data() + kernels_->lanes;
  for (int y = rows.begin; y < rows.end; ++y) {
    FeatureRowOf(left_, settings, y,
                 left_features_.Reserve(0) + static_cast<size_t>(y) * plan.planes * width);
    FeatureRowOf(right_, settings, y, right);
    const size_t plane = plan.stripes * plan.right_stride;
    uint8_t* striped = right_features_.Reserve(0) + static_cast<size_t>(y) * plan.planes * plane;
    for (int p = 0; p < plan.planes; ++p) {
      kernels_->stripe_row(plan, right + p * width, striped + p * plane);
    }
  }
}

void CpuMatcher::FeatureRowOf(const PaddedPicture& picture, const SgmSettings& settings, int y,
                              uint8_t* planes) const {
  const bool census = settings.cost == MatchCost::kAdCensus || settings.cost == MatchCost::kCensus;
  if (!census || picture.width() < kernels_->lanes) {
    return FeatureRow(picture, settings, y, planes);
  }
  ptrdiff_t steps[64];
  const int count = CensusSteps(settings.census, picture.Row(1) - picture.Row(0), steps);
  kernels_->census_row({.centre = picture.Row(y),
                        .neighbours = steps,
                        .count = count,
                        .width = picture.width(),
                        .codes = planes});
  if (settings.cost == MatchCost::kAdCensus) {
    CoarseGreyRow(picture, y,
                  planes + static_cast<size_t>(CensusBytes(settings.census)) * picture.width());
  }
}

void CpuMatcher::RunSweeps(int directions, int part, int parts) {
  const int height = frame_.plan.height;
  if (SharesOf(directions).backward == 0) {
    const RowRange rows = ShareOf(height, part, parts);
    sweeps_[part]->Rows(0, rows.begin, rows.end - rows.begin, SweepMode::kOnly);
    return;
  }
  if (parts == 1) {
    sweeps_[0]->Rows(0, 0, height, SweepMode::kStore);
    sweeps_[1]->Rows(0, 0, height, SweepMode::kFinish);
    return;
  }
  const int blocks = parts / 2;
  const int which = part / blocks;  // an odd part is left over
  const int first = which == 0 ? height / 2 : height - height / 2;
  if (which < 2) sweeps_[which]->Rows(part % blocks, 0, first, SweepMode::kStore);
  meeting_.Wait();
  if (which < 2) sweeps_[which]->Rows(part % blocks, first, height - first, SweepMode::kFinish);
}

const Kernels* BestKernels() {
  for (const Kernels* kernels : {Avx512Kernels(), Avx2Kernels()}) {
    if (kernels != nullptr) return kernels;
  }
  return PortableKernels();
}

}  // namespace

VS_REGISTER_MATCHER("cpu", 100, [] {
  return Result<std::unique_ptr<StereoMatcher>>(std::make_unique<CpuMatcher>(BestKernels()));
});

Result<std::unique_ptr<StereoMatcher>> MakeCpuMatcher(const Kernels* kernels) {
  if (kernels == nullptr) return NotFound("this processor cannot run these instructions");
  return std::make_unique<CpuMatcher>(kernels);
}

}  // namespace vs::cpu
