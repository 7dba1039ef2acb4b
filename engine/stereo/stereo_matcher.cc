#include "engine/stereo/stereo_matcher.h"

#include <algorithm>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/str.h"

namespace vs {

Result<DisparityMap> StereoMatcher::Match(const GreyImage& left, const GreyImage& right,
                                          const SgmSettings& settings, int threads,
                                          BufferPool& pool) {
  VS_RETURN_IF_ERROR(ValidateSettings(settings));
  VS_RETURN_IF_ERROR(ValidatePair(left, right));
  return MatchPair(left, right, settings, threads, pool);
}

StereoMatchers& StereoMatchers::Get() {
  static StereoMatchers matchers;
  return matchers;
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
