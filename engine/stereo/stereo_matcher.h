#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/status.h"
#include "engine/image/buffer.h"
#include "engine/image/disparity_map.h"
#include "engine/image/image.h"
#include "engine/stereo/sgm_settings.h"
#include "engine/stereo/stereo_plan.h"

namespace vs {

// Computes disparity by semi-global matching (Hirschmueller 2008). A backend implements it and
// registers with VS_REGISTER_MATCHER. All backends answer alike, bit for bit; `reference` is the
// plain one that defines the answer.
//
// A matcher keeps its working memory from picture to picture, so make one per stream of pictures;
// it must not be called by two threads at once.
class StereoMatcher {
 public:
  virtual ~StereoMatcher() = default;

  // Matches a rectified pair. The result's memory comes from `pool`; its geometry holds the size
  // only, the caller knows the rest. `threads` (at least 1) changes the time, never the result.
  // Errors: INVALID_ARGUMENT as ValidateSettings and ValidatePair say, RESOURCE_EXHAUSTED when
  // there is not enough memory.
  Result<DisparityMap> Match(const GreyImage& left, const GreyImage& right,
                             const SgmSettings& settings, int threads, BufferPool& pool);
  // All the way of a pair: rectifies it, matches it and computes depth, as far as `plan` wants it;
  // exactly what Rectified, MatchRegion and DepthFromDisparity make one after the other. A device
  // does all without coming back to the host in between; elsewhere it is those three. Errors as
  // these, INVALID_ARGUMENT also for pictures that do not have the raw size.
  Result<StereoResult> Process(const GreyImage& left, const GreyImage& right,
                               const StereoPlan& plan, int threads, BufferPool& pool);
  // Makes room for pairs of this size that go by `plan`, where the backend has memory of its own to
  // run out of; others make it with the first pair. RESOURCE_EXHAUSTED says how many bytes are
  // needed and how many there are.
  virtual Status Reserve(const StereoPlan& plan, int width, int height);
  // The large memory that it keeps from picture to picture (each backend's text says how much it
  // takes); what the pool holds does not count.
  virtual size_t WorkingBytes() const = 0;

 private:
  // What Match does with a valid pair as it was given. A backend begins with ConditionPair, or
  // with what equals it.
  virtual Result<DisparityMap> MatchPair(const GreyImage& left, const GreyImage& right,
                                         const SgmSettings& settings, int threads,
                                         BufferPool& pool) = 0;
  // What Process does with valid pictures and a valid plan of the whole picture; what a
  // backend on the host need not write.
  virtual Result<StereoResult> ProcessPair(const GreyImage& left, const GreyImage& right,
                                           const StereoPlan& plan, int threads, BufferPool& pool);
};

// NOT_FOUND or UNAVAILABLE when this machine cannot run the backend (no such device, no such
// instructions).
using MatcherFactory = std::function<Result<std::unique_ptr<StereoMatcher>>()>;

// The backends. Filled while the program starts, read-only afterwards.
class StereoMatchers {
 public:
  static StereoMatchers& Get();

  // True. A higher rank is a faster backend: 0 reference, 100 CPU, 200 GPU. Two backends of one
  // name are a bug of ours.
  bool Add(std::string name, int speed_rank, MatcherFactory factory);
  // Fastest first.
  std::vector<std::string> Names() const;
  // `name` of a backend, or "auto" for the fastest that this machine can run. NOT_FOUND names the
  // backends that there are.
  Result<std::unique_ptr<StereoMatcher>> Make(std::string_view name) const;

 private:
  struct Entry {
    std::string name;
    int speed_rank;
    MatcherFactory factory;
  };
  std::vector<Entry> entries_;  // fastest first
};

#define VS_REGISTER_MATCHER(name, speed_rank, factory)    \
  [[maybe_unused]] static const bool kMatcherRegistered = \
      ::vs::StereoMatchers::Get().Add(name, speed_rank, factory)

}  // namespace vs
