#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/base/status.h"
#include "engine/core/param.h"
#include "engine/stereo/stereo_matcher.h"

namespace vs {

// The parameters by which a user chooses who matches.
class MatcherParams {
 public:
  explicit MatcherParams(Block* owner) : owner_(owner) {}

  Result<std::unique_ptr<StereoMatcher>> MakeMatcher() const {
    return StereoMatchers::Get().Make(*backend_);
  }
  int Threads() const { return *threads_; }

 private:
  static std::vector<std::string> Backends() {
    std::vector<std::string> names = StereoMatchers::Get().Names();
    names.insert(names.begin(), "auto");
    return names;
  }

  Block* owner_;

  Param<std::string> backend_{
      owner_,
      "backend",
      {.initial = "auto",
       .choices = Backends(),
       .live = false,
       .doc = "Who computes: all backends give the same answer, auto takes the fastest."}};
  Param<int> threads_{owner_,
                      "threads",
                      {.initial = 2,
                       .min = 1,
                       .max = 64,
                       .doc = "Processor cores to use; the result does not depend on it."}};
};

}  // namespace vs
