#include "client/cli/output.h"

#include <gtest/gtest.h>

#include <google/protobuf/timestamp.pb.h>

#include "client/cli/words.h"

namespace vs::cli {
namespace {

namespace v1 = ::visionserver::v1;

TEST(Output, AlignsColumnsAndNumbers) {
  Table table({"CAMERA", ">FPS", "STATE"});
  table.Add({"left", "9.5", "streaming"});
  table.Add(
      {"r\xC3\xA9"
       "al",
       "30.0", ""});
  testing::internal::CaptureStdout();
  table.Print("none");
  EXPECT_EQ(
      "CAMERA   FPS  STATE\n"
      "left     9.5  streaming\n"
      "r\xC3\xA9"
      "al    30.0\n",
      testing::internal::GetCapturedStdout());
}

TEST(Output, SaysThatATableIsEmpty) {
  testing::internal::CaptureStdout();
  Table({"CAMERA"}).Print("No cameras.");
  EXPECT_EQ("No cameras.\n", testing::internal::GetCapturedStdout());
}

TEST(Output, KeepsForeignTextFromSteeringTheTerminal) {
  EXPECT_EQ("a?[31mb?c", Printable("a\x1b[31mb\nc"));
  EXPECT_EQ("x?y", Printable("x\xC2\x9By"));
  EXPECT_EQ("M\xC3\xBCller", Printable("M\xC3\xBCller"));
}

TEST(Output, PrintsErrorsOnOneLineAndFaultsBelow) {
  const client::Error error{.code = client::Code::kInvalidArgument,
                            .message = "stereo has 1 fault",
                            .reason = "INVALID_ARGUMENT",
                            .faults = {{.subject = "match", .message = "is not connected"}}};
  testing::internal::CaptureStderr();
  PrintError(error, false);
  PrintError(error, true);
  EXPECT_EQ(
      "visionctl: stereo has 1 fault\n"
      "  match: is not connected\n"
      "{\"code\":\"INVALID_ARGUMENT\",\"faults\":[{\"message\":\"is not connected\",\"subject\":"
      "\"match\"}],\"message\":\"stereo has 1 fault\",\"reason\":\"INVALID_ARGUMENT\"}\n",
      testing::internal::GetCapturedStderr());
}

TEST(Output, TellsASingleFaultOnce) {
  testing::internal::CaptureStderr();
  PrintError({.code = client::Code::kInvalidArgument,
              .message = "match.p2: 96 is more than 64",
              .reason = "INVALID_ARGUMENT",
              .faults = {{.subject = "match.p2", .message = "96 is more than 64"}}},
             false);
  EXPECT_EQ("visionctl: match.p2: 96 is more than 64\n", testing::internal::GetCapturedStderr());
}

TEST(Words, StandForEnumerations) {
  EXPECT_EQ("admin", RoleWord(v1::ROLE_ADMIN));
  EXPECT_EQ("grey picture", StreamKindWord(v1::STREAM_KIND_GREY_PICTURE));
  EXPECT_EQ("unspecified", RunStateWord(v1::SEQUENCE_RUN_STATE_UNSPECIFIED));
  EXPECT_EQ("unknown", RoleWord(static_cast<v1::Role>(99)));
  EXPECT_EQ(v1::ROLE_ENGINEER, *ParseRole("engineer"));
  EXPECT_FALSE(ParseRole("boss"));
  EXPECT_FALSE(ParseRole("unspecified"));
  EXPECT_EQ(v1::RESULT_CLASS_FAIL, *ParseResultClass("fail"));
  EXPECT_EQ(v1::RESULT_CLASS_UNSPECIFIED, *ParseResultClass(""));
}

TEST(Words, ReadTimes) {
  EXPECT_EQ(1'769'868'180, ParseTime("2026-01-31T14:03:00Z")->seconds());
  EXPECT_EQ(0, ParseTime("2026-01-31 14:03:30")->seconds() -
                   ParseTime("2026-01-31 14:03")->seconds() - 30);
  EXPECT_TRUE(ParseTime("2026-01-31"));
  EXPECT_FALSE(ParseTime("yesterday"));
  EXPECT_FALSE(ParseTime("2026-01-31x"));
}

}  // namespace
}  // namespace vs::cli
