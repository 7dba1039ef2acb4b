// Any output of a running sequence, without a Publish block, over the real API.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/server/streams/published.h"
#include "tests/server/vision/vision_fixture.h"

namespace vs::test {
namespace {

namespace pb = visionserver::v1;
using ::testing::Contains;
using ::testing::HasSubstr;

class Taps : public VisionTest {
 protected:
  // Matches simulated pictures; publishes nothing.
  void CreateMatch() {
    SequenceSpec spec;
    spec.id = "match";
    spec.blocks = {
        {"source", "SimulatedStereo", {{"rate_hz", 10.0}}},
        {"small", "Resize", {{"scale", 0.2}}},
        {"sgm", "SgmStereo", {{"num_disparities", int64_t{32}}, {"directions", int64_t{4}}}},
        {"depth", "DisparityToDepth"},
        {"points", "DepthToPoints"}};
    spec.connections = {{"source", "pair", "small", "pair"},
                        {"small", "resized", "sgm", "pair"},
                        {"sgm", "disparity", "depth", "disparity"},
                        {"depth", "depth", "points", "depth"}};
    Create(spec);
  }
  void Restart() {
    ASSERT_TRUE(Stop("match").ok());
    ASSERT_TRUE(Start("match").ok());
  }
};

TEST_F(Taps, GiveWhatABlockPutsOut) {
  CreateMatch();
  StreamClient client(server_.Connect(), operator_,
                      {Wish(1, "match/source.pair"), Wish(2, "match/sgm.disparity")});
  ASSERT_TRUE(Start("match").ok());
  uint64_t pictures = 0;
  uint64_t maps = 0;
  while (pictures == 0 || maps == 0) {
    pb::StreamItem item;
    ASSERT_TRUE(client.Take(&item));
    EXPECT_GT(item.header().frame_number(), 0u);
    if (item.subscription_id() == 1) {
      EXPECT_EQ(pb::STREAM_KIND_GREY_PICTURE, item.header().kind());
      EXPECT_EQ(pb::CODEC_JPEG, item.header().codec());
      ++pictures;
    } else {
      EXPECT_EQ(pb::STREAM_KIND_DISPARITY, item.header().kind());
      EXPECT_EQ(size_t{item.header().width()} * item.header().height(),
                UnpackDisparity(item).size());
      ++maps;
    }
  }
  EXPECT_THAT(client.notices(), Contains(HasSubstr("no running sequence")));
  pb::ListStreamsResponse list;
  ASSERT_TRUE(streams_->ListStreams(ClientCall(operator_).context(), {}, &list).ok());
  EXPECT_EQ(0, list.streams_size());
}

TEST_F(Taps, GoOnWhenTheSequenceIsStartedAgain) {
  CreateMatch();
  ASSERT_TRUE(Start("match").ok());
  StreamClient client(server_.Connect(), operator_, {Wish(1, "match/sgm.disparity")});
  pb::StreamItem before;
  ASSERT_TRUE(client.Take(&before));
  ASSERT_NO_FATAL_FAILURE(Restart());
  const int64_t restarted_ns = SystemClock().MonotonicNs();
  pb::StreamItem after;
  while (after.header().capture_ns() < restarted_ns) {
    ASSERT_TRUE(client.Take(&after));
    EXPECT_GT(after.seq(), before.seq());
  }
}

TEST_F(Taps, ComeAsSmallAsTheyAreDrawn) {
  CreateMatch();
  ASSERT_TRUE(Start("match").ok());
  pb::Subscription preview = Wish(1, "match/source.pair");
  preview.set_max_width_px(200);
  pb::Subscription map = Wish(2, "match/source.pair");
  map.set_codec(pb::CODEC_RAW);
  StreamClient client(server_.Connect(), operator_, {preview, map});
  uint32_t small = 0;
  uint32_t whole = 0;
  while (small == 0 || whole == 0) {
    pb::StreamItem item;
    ASSERT_TRUE(client.Take(&item));
    const pb::FrameHeader& header = item.header();
    (item.subscription_id() == 1 ? small : whole) = header.width();
    EXPECT_EQ(item.subscription_id() == 1 ? 4u : 1u, header.step());
  }
  EXPECT_EQ(648u, whole);
  EXPECT_EQ(162u, small);  // 648 / 4
}

TEST_F(Taps, AreWaitedForByGetLatest) {
  CreateMatch();
  ASSERT_TRUE(Start("match").ok());
  pb::GetLatestRequest request;
  request.set_stream("match/small.resized");
  request.mutable_wait()->set_seconds(60);
  pb::StreamItem item;
  const grpc::Status status = streams_->GetLatest(ClientCall(operator_).context(), request, &item);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(pb::STREAM_KIND_GREY_PICTURE, item.header().kind());
}

TEST_F(Taps, SayWhatIsWrongWithAName) {
  CreateMatch();
  ASSERT_TRUE(Start("match").ok());
  pb::GetLatestRequest request;
  pb::StreamItem item;
  const auto told = [&](const std::string& stream, grpc::StatusCode code) {
    request.set_stream(stream);
    const grpc::Status status =
        streams_->GetLatest(ClientCall(operator_).context(), request, &item);
    EXPECT_EQ(code, status.error_code()) << stream;
    return status.error_message();
  };
  EXPECT_THAT(told("match/sgm.depth", grpc::StatusCode::NOT_FOUND),
              HasSubstr("the outputs of block sgm of sequence match are"));
  EXPECT_THAT(told("match/nobody.depth", grpc::StatusCode::NOT_FOUND),
              HasSubstr("sequence match has no block \"nobody\""));
  EXPECT_THAT(told("other/sgm.disparity", grpc::StatusCode::NOT_FOUND),
              HasSubstr("no running sequence"));
  EXPECT_THAT(told("match/points.points", grpc::StatusCode::INVALID_ARGUMENT),
              HasSubstr("cannot be sent"));
}

}  // namespace
}  // namespace vs::test
