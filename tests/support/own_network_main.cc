#include <gtest/gtest.h>

#include <cstdio>
#include <string_view>

#include "tests/support/network_namespace.h"

namespace {

bool OnlyLists(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--gtest_list_tests") return true;
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  if (!OnlyLists(argc, argv)) {
    if (const auto reason = vs::test::EnterOwnNetwork(argc, argv)) {
      std::printf("[  SKIPPED ] no network of its own for this test: %s\n", reason->c_str());
      return 0;
    }
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
