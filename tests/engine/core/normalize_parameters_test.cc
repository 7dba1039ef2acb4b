#include "engine/core/normalize_parameters.h"

#include <gtest/gtest.h>

#include "tests/engine/core/test_blocks.h"

namespace vs {
namespace {

TEST(NormalizeParameters, MakesSpecsEqualThatMeanTheSame) {
  SequenceSpec spec = ChainSpec("line", {"step"});
  spec.blocks.push_back({"limits", "TestLimits", {{"low", 5.0}}});
  SequenceSpec same = spec;
  same.blocks[1].params["offset"] = int64_t{0};
  same.blocks[2].params = {{"low", int64_t{5}}, {"high", int64_t{10}}};
  ASSERT_NE(ToJson(same), ToJson(spec));
  NormalizeParameters(&same);
  EXPECT_EQ(same, spec);
  EXPECT_EQ(ToJson(same), ToJson(spec));
}

TEST(NormalizeParameters, LeavesAloneWhatItDoesNotKnowAndWhatDoesNotFit) {
  SequenceSpec spec = ChainSpec("line", {"step"});
  spec.blocks[1].params["speed"] = int64_t{1};
  spec.blocks[1].params["offset"] = 0.0;
  spec.blocks.push_back({"ghost", "NoSuchBlock", {{"offset", int64_t{0}}}});
  const SequenceSpec before = spec;
  NormalizeParameters(&spec);
  EXPECT_EQ(spec, before);
}

}  // namespace
}  // namespace vs
