#include "engine/core/registry.h"

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/core/block.h"

namespace vs {
namespace {

TEST(BlockRegistry, RefusesTwoTypesOfOneName) {
  BlockRegistry& registry = BlockRegistry::Get();
  EXPECT_THROW(registry.Add("TestStep", {"Test", "Another."}, nullptr), BrokenInvariant);
  EXPECT_EQ(registry.Find("TestStep")->info.doc, "Adds.");
}

}  // namespace
}  // namespace vs
