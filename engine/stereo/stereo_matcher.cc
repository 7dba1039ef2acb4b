#include "engine/stereo/stereo_matcher.h"

#include <algorithm>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/str.h"
#include "engine/stereo/depth.h"
#include "engine/stereo/match_region.h"

namespace vs {
namespace {

Status ValidateRaw(const GreyImage& left, const GreyImage& right, const Rectification& expected) {
  for (const GreyImage* raw : {&left, &right}) {
    if (raw->width() == expected.raw_width && raw->height() == expected.raw_height) continue;
    return InvalidArgument(Str("rectification: a picture has ", raw->width(), " x ", raw->height(),
                               " px, expected ", expected.raw_width, " x ", expected.raw_height,
                               " px; set both cameras to the same size"));
  }
  return ValidateSize(expected.left.width, expected.left.height);
}

}  // namespace

Result<DisparityMap> StereoMatcher::Match(const GreyImage& left, const GreyImage& right,
                                          const SgmSettings& settings, int threads,
                                          BufferPool& pool) {
  VS_RETURN_IF_ERROR(ValidateSettings(settings));
  VS_RETURN_IF_ERROR(ValidatePair(left, right));
  return MatchPair(left, right, settings, threads, pool);
}

Result<StereoResult> StereoMatcher::Process(const GreyImage& left, const GreyImage& right,
                                            const StereoPlan& plan, int threads, BufferPool& pool) {
  VS_RETURN_IF_ERROR(ValidateSettings(plan.settings));
  VS_RETURN_IF_ERROR(plan.rectification != nullptr ? ValidateRaw(left, right, *plan.rectification)
                                                   : ValidatePair(left, right));
  if (plan.depth) {
    VS_RETURN_IF_ERROR(CheckDepthGeometry(GeometryOf(plan, left.width(), left.height())));
  }
  const Rectification* how = plan.rectification.get();
  const int width = how != nullptr ? how->left.width : left.width();
  const int height = how != nullptr ? how->left.height : left.height();
  const PixelRect whole{0, 0, width, height};
  // A region is cut out here on the host, so its pair is rectified here, too.
  return plan.region && Inside(*plan.region, width, height) != whole
             ? StereoMatcher::ProcessPair(left, right, plan, threads, pool)
             : ProcessPair(left, right, plan, threads, pool);
}

Result<StereoResult> StereoMatcher::ProcessPair(const GreyImage& left, const GreyImage& right,
                                                const StereoPlan& plan, int threads,
                                                BufferPool& pool) {
  const auto rectified = [&](const GreyImage& picture, RemapTable Rectification::*table) {
    const Rectification* how = plan.rectification.get();
    return how == nullptr ? picture : Rectified(picture, *how, how->*table, pool);
  };
  StereoResult result{.left = rectified(left, &Rectification::left)};
  const GreyImage right_picture = rectified(right, &Rectification::right);
  const int width = result.left.width();
  const int height = result.left.height();
  const PixelRect region = plan.region.value_or(PixelRect{0, 0, width, height});
  VS_ASSIGN_OR_RETURN(result.disparity, MatchRegion(*this, result.left, right_picture, region,
                                                    plan.settings, threads, pool));
  result.disparity.geometry = GeometryOf(plan, width, height);
  if (plan.depth) {
    VS_ASSIGN_OR_RETURN(result.depth, DepthFromDisparity(result.disparity, pool));
  }
  return result;
}

StereoMatchers& StereoMatchers::Get() {
  static StereoMatchers matchers;
  return matchers;
}

Status StereoMatcher::Reserve(const StereoPlan& /*plan*/, int /*width*/, int /*height*/) {
  return {};
}

bool StereoMatchers::Add(std::string name, int speed_rank, MatcherFactory factory) {
  VS_CHECK(std::none_of(entries_.begin(), entries_.end(),
                        [&](const Entry& entry) { return entry.name == name; }));
  entries_.push_back({std::move(name), speed_rank, std::move(factory)});
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const Entry& a, const Entry& b) { return a.speed_rank > b.speed_rank; });
  return true;
}

std::vector<std::string> StereoMatchers::Names() const {
  std::vector<std::string> names;
  for (const Entry& entry : entries_) names.push_back(entry.name);
  return names;
}

Result<std::unique_ptr<StereoMatcher>> StereoMatchers::Make(std::string_view name) const {
  std::string known;
  for (const Entry& entry : entries_) {
    known += (known.empty() ? "" : ", ") + entry.name;
    if (name != "auto" && name != entry.name) continue;
    auto matcher = entry.factory();
    if (matcher.has_value() || name != "auto") return matcher;
  }
  return NotFound(Str("there is no matcher \"", name, "\" that runs on this machine; choose auto",
                      known.empty() ? "" : ", ", known));
}

}  // namespace vs
