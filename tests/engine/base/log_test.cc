#include "engine/base/log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace vs {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using namespace std::string_literals;  // they may contain a zero

// What `write` writes to standard error.
template <class Write>
std::string Written(const Write& write) {
  testing::internal::CaptureStderr();
  write();
  return testing::internal::GetCapturedStderr();
}

TEST(Log, WritesOneLineWithLevelAndComponent) {
  EXPECT_THAT(Written([] { LogWarn("camera", "gev:21000001 is slow"); }),
              EndsWith("Z warning camera: gev:21000001 is slow\n"));
}

TEST(Log, NoTextCanForgeALineOrSteerATerminal) {
  const std::string text = "login of \"eve\r\n2030-01-01T00:00:00Z error all: \x1b[2J\x7f\0"s;
  const std::string line = Written([&text] { LogInfo("access", text); });
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1) << line;
  EXPECT_EQ(std::count_if(line.begin(), line.end(), [](char c) { return c >= 0 && c < ' '; }), 1);
  EXPECT_THAT(line,
              HasSubstr("\"eve\\x0d\\x0a2030-01-01T00:00:00Z error all: \\x1b[2J\\x7f\\x00\n"));
}

TEST(Log, KeepsOtherLanguagesReadable) {
  EXPECT_THAT(Written([] { LogInfo("user", "J\xc3\xb6rg"); }), EndsWith("user: J\xc3\xb6rg\n"));
}

TEST(Log, WritesNothingBelowItsLevel) {
  EXPECT_EQ(Written([] { LogDebug("camera", "frame 1"); }), "");
  SetLogLevel(LogLevel::kError);
  EXPECT_EQ(Written([] { LogWarn("camera", "slow"); }), "");
  SetLogLevel(LogLevel::kDebug);
  EXPECT_THAT(Written([] { LogDebug("camera", "frame 1"); }), HasSubstr(" debug camera: frame 1"));
  SetLogLevel(LogLevel::kInfo);
}

}  // namespace
}  // namespace vs
