#include "server/rpc/error_details.h"

#include <gtest/gtest.h>

#include "visionserver/v1/error.pb.h"

#include "engine/base/str.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;

pb::ErrorDetail DetailOf(const WireError& error) {
  pb::ErrorStatus status;
  EXPECT_TRUE(status.ParseFromString(error.details));
  EXPECT_EQ(status.details_size(), 1);
  pb::ErrorDetail detail;
  EXPECT_TRUE(status.details(0).UnpackTo(&detail));
  return detail;
}

TEST(ErrorDetails, CarriesReasonAndFaults) {
  const Status status = Status(StatusCode::kInvalidArgument, "2 faults",
                               {{"match.p1", "is 900, at most 255"}, {"depth", "has no rig"}})
                            .WithReason("SEQUENCE_HAS_FAULTS");
  const WireError error = ToWireError(status);
  EXPECT_EQ(error.message, "2 faults");
  pb::ErrorStatus whole;
  ASSERT_TRUE(whole.ParseFromString(error.details));
  EXPECT_EQ(whole.code(), 3);  // gRPC's INVALID_ARGUMENT
  const pb::ErrorDetail detail = DetailOf(error);
  EXPECT_EQ(detail.domain(), "vs");
  EXPECT_EQ(detail.reason(), "SEQUENCE_HAS_FAULTS");
  ASSERT_EQ(detail.faults_size(), 2);
  EXPECT_EQ(detail.faults(0).subject(), "match.p1");
  EXPECT_EQ(detail.faults(1).message(), "has no rig");
}

TEST(ErrorDetails, ReasonIsTheCodeUnlessThereIsABetterOne) {
  EXPECT_EQ(DetailOf(ToWireError(NotFound("no camera"))).reason(), "NOT_FOUND");
}

TEST(ErrorDetails, LeavesOutWhatAClientCouldNotReceive) {
  std::vector<Fault> faults;
  faults.reserve(5000);
  for (int i = 0; i < 5000; ++i) faults.push_back({Str("block", i), "no such block type"});
  const WireError error =
      ToWireError(Status(StatusCode::kInvalidArgument, std::string(100'000, 'x'), faults));
  // gRPC's clients take 8 kB of trailers; base64 makes binary ones a third longer.
  EXPECT_LT(error.message.size() + error.details.size() * 4 / 3, 8000U);
  const pb::ErrorDetail detail = DetailOf(error);
  EXPECT_GT(detail.faults_size(), 20);
  EXPECT_EQ(detail.faults(0).subject(), "block0");
  EXPECT_EQ(detail.faults(detail.faults_size() - 1).message(),
            Str(5001 - detail.faults_size(), " more; correct these first"));
}

TEST(ErrorDetails, CutsBetweenCharacters) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "ä";
  const std::string message = ToWireError(Internal(text)).message;
  EXPECT_LE(message.size(), 1024U);
  EXPECT_TRUE(message.ends_with("ä..."));
}

}  // namespace
}  // namespace vs
