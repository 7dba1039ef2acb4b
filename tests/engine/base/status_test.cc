#include "engine/base/status.h"

#include <gtest/gtest.h>

namespace vs {
namespace {

Result<int> Half(int value) {
  if (value % 2 != 0) return InvalidArgument("expected an even number");
  return value / 2;
}

Result<int> Quarter(int value) {
  VS_ASSIGN_OR_RETURN(const int half, Half(value));
  return Half(half);
}

Status CheckQuarter(int value) {
  VS_RETURN_IF_ERROR(Quarter(value).has_value() ? Status() : OutOfRange("no quarter"));
  return Status();
}

TEST(Status, ResultCarriesTheValueOrTheError) {
  EXPECT_EQ(Quarter(12).value(), 3);
  EXPECT_EQ(Quarter(6).error().code(), StatusCode::kInvalidArgument);
  EXPECT_TRUE(CheckQuarter(12).ok());
  EXPECT_EQ(CheckQuarter(6).code(), StatusCode::kOutOfRange);
}

TEST(Status, TextNamesTheCodeAndEveryFault) {
  const Status status(StatusCode::kInvalidArgument, "2 faults",
                      {{"match", "no such block type"}, {"depth.rig", "missing"}});
  EXPECT_EQ(status.Annotated("stereo_depth").ToString(),
            "INVALID_ARGUMENT: stereo_depth: 2 faults\n"
            "  match: no such block type\n"
            "  depth.rig: missing");
}

TEST(Status, ReasonIsTheNameOfTheCodeUnlessSaidMorePrecisely) {
  EXPECT_EQ(NotFound("no camera").reason(), "NOT_FOUND");
  EXPECT_EQ(Unavailable("no camera").WithReason("CAMERA_OFFLINE").Annotated("left").reason(),
            "CAMERA_OFFLINE");
}

}  // namespace
}  // namespace vs
