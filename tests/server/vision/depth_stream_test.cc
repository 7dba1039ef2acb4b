// The main job over the real API: pictures in, maps out, to every client the newest.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "visionserver/v1/session.grpc.pb.h"

#include "tests/server/streams/published.h"
#include "tests/server/vision/vision_fixture.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

namespace pb = visionserver::v1;
using ::testing::HasSubstr;

// A simulated pair -> matcher -> stream "depth"; small enough for a busy machine. With rate 0 each
// frame of the scene is processed, so two runs see the same pictures.
SequenceSpec DepthSpec() {
  SequenceSpec spec;
  spec.id = "stereo_depth";
  spec.blocks = {
      {"source", "SimulatedStereo", {{"rate_hz", 0.0}}},
      {"match", "SgmStereo", {{"num_disparities", int64_t{32}}, {"directions", int64_t{4}}}},
      {"publish", "Publish", {{"stream", std::string("depth")}}},
  };
  spec.connections = {{"source", "pair", "match", "pair"},
                      {"match", "disparity", "publish", "value"}};
  return spec;
}

// The pictures alone, as fast as asked for.
SequenceSpec PictureSpec(double rate_hz) {
  SequenceSpec spec;
  spec.id = "pictures";
  spec.blocks = {{"source", "SimulatedStereo", {{"rate_hz", rate_hz}}},
                 {"publish", "Publish", {{"stream", std::string("left")}}}};
  spec.connections = {{"source", "pair", "publish", "value"}};
  return spec;
}

pb::Subscription Raw(pb::Subscription wanted) {
  wanted.set_codec(pb::CODEC_RAW);
  return wanted;
}

class DepthStream : public VisionTest {
 protected:
  explicit DepthStream(TestServerOptions options = {}) : VisionTest(std::move(options)) {}

  // The first `count` maps of a fresh run, by frame number.
  std::map<uint64_t, std::vector<uint16_t>> MapsOfOneRun(size_t count) {
    std::map<uint64_t, std::vector<uint16_t>> maps;
    StreamClient client(server_.Connect(), operator_, {Wish(1, "stereo_depth/depth", 16)});
    EXPECT_TRUE(Start("stereo_depth").ok());
    while (maps.size() < count) {
      pb::StreamItem item;
      if (!client.Take(&item)) break;
      maps[item.header().frame_number()] = UnpackDisparity(item);
    }
    EXPECT_TRUE(Stop("stereo_depth").ok());
    return maps;
  }
};

TEST_F(DepthStream, EveryCodecGivesTheSameMapToTheLastBit) {
  Create(DepthSpec());
  StreamClient client(server_.Connect(), operator_,
                      {Raw(Wish(1, "stereo_depth/depth", 16)), Wish(2, "stereo_depth/depth", 16)});
  const grpc::Status started = Start("stereo_depth");
  ASSERT_TRUE(started.ok()) << started.error_message();
  std::map<uint64_t, std::vector<uint16_t>> raw;
  int compared = 0;
  while (compared < 2) {
    pb::StreamItem item;
    ASSERT_TRUE(client.Take(&item));
    EXPECT_EQ(pb::STREAM_KIND_DISPARITY, item.header().kind());
    EXPECT_GT(item.header().geometry().focal_px(), 0);
    const std::vector<uint16_t> pixels = UnpackDisparity(item);
    ASSERT_EQ(648u * 483, pixels.size());
    const auto [known, added] = raw.try_emplace(item.seq(), pixels);
    if (added) continue;
    EXPECT_EQ(known->second, pixels) << "item " << item.seq();
    ++compared;
  }
  EXPECT_EQ(pb::SEQUENCE_RUN_STATE_RUNNING, State("stereo_depth").state());
}

// Compares the frames that both runs delivered: a busy machine may pass over some.
void ExpectSameMaps(const std::map<uint64_t, std::vector<uint16_t>>& one,
                    const std::map<uint64_t, std::vector<uint16_t>>& other) {
  int common = 0;
  for (const auto& [number, map] : one) {
    const auto found = other.find(number);
    if (found == other.end()) continue;
    ++common;
    EXPECT_EQ(map, found->second) << "frame " << number;
  }
  EXPECT_GT(common, 0);
}

TEST_F(DepthStream, TheSamePicturesGiveTheSameMapsAgain) {
  Create(DepthSpec());
  ExpectSameMaps(MapsOfOneRun(3), MapsOfOneRun(3));
}

class OneWorker : public DepthStream {
 protected:
  OneWorker() : DepthStream({.config = "processing { workers: 1 }"}) {}
};

TEST_F(OneWorker, GivesTheSameMapsAsTwo) {
  Create(DepthSpec());
  const auto one = MapsOfOneRun(3);
  TestServer two({.config = "processing { workers: 2 }"});
  const auto channel = two.Connect();
  const std::string token = two.Token(Role::kEngineer);
  pb::CreateSequenceRequest create;
  create.set_id("stereo_depth");
  pb::GetSequenceRequest get;
  get.set_id("stereo_depth");
  pb::Sequence stored;
  ASSERT_TRUE(sequences_->GetSequence(ClientCall(engineer_).context(), get, &stored).ok());
  *create.mutable_spec() = stored.spec();
  const auto sequences = pb::SequenceService::NewStub(channel);
  ASSERT_TRUE(sequences->CreateSequence(ClientCall(token).context(), create, &stored).ok());
  StreamClient client(two.Connect(), token, {Wish(1, "stereo_depth/depth", 16)});
  pb::StartSequenceRequest start;
  start.set_id("stereo_depth");
  pb::SequenceState state;
  ASSERT_TRUE(sequences->StartSequence(ClientCall(token).context(), start, &state).ok());
  std::map<uint64_t, std::vector<uint16_t>> other;
  pb::StreamItem item;
  while (other.size() < 3 && client.Take(&item)) {
    other[item.header().frame_number()] = UnpackDisparity(item);
  }
  ExpectSameMaps(one, other);
}

TEST_F(DepthStream, AClientThatDoesNotAcknowledgeGetsTheNewestLater) {
  Create(PictureSpec(100));
  ASSERT_TRUE(Start("pictures").ok());
  StreamClient slow(server_.Connect(), operator_, {Wish(1, "pictures/left", 1)});
  StreamClient quick(server_.Connect(), operator_, {Wish(1, "pictures/left", 2)});
  pb::StreamItem first;
  ASSERT_TRUE(slow.Read(&first));
  pb::StreamItem item;
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(quick.Take(&item));
  slow.Ack(first);
  pb::StreamItem next;
  ASSERT_TRUE(slow.Read(&next));
  EXPECT_GE(next.seq(), item.seq());
  EXPECT_EQ(next.seq() - first.seq() - 1, next.dropped());
}

class Impatient : public DepthStream {
 protected:
  Impatient() : DepthStream({.config = "limits { unread_ms: 500 }"}) {}
};

TEST_F(Impatient, AClientThatNeverReadsLosesItsStreamAndTheOthersDoNotNotice) {
  Create(PictureSpec(50));
  ASSERT_TRUE(Start("pictures").ok());
  StreamClient stalled(server_.Connect(), operator_, {Raw(Wish(1, "pictures/left", 16))});
  StreamClient reading(server_.Connect(), operator_, {Raw(Wish(1, "pictures/left", 2))});
  // Nobody reads the stalled one; the server gives it up.
  pb::StreamItem item;
  EXPECT_TRUE(WaitUntil([&] {
    EXPECT_TRUE(reading.Take(&item));
    return server_->dispatcher().OpenStreams() == 1;
  }));
  ASSERT_TRUE(reading.Take(&item));
  while (stalled.Read(&item)) {
  }
  EXPECT_FALSE(stalled.Finish().ok());
  EXPECT_TRUE(reading.Take(&item));
}

TEST_F(DepthStream, ARobotTakesTheLatestItemWithoutAStream) {
  Create(PictureSpec(50));
  pb::GetLatestRequest request;
  request.set_stream("pictures/left");
  request.set_codec(pb::CODEC_RAW);
  pb::StreamItem item;
  EXPECT_EQ(grpc::StatusCode::NOT_FOUND,
            streams_->GetLatest(ClientCall(operator_).context(), request, &item).error_code());
  ASSERT_TRUE(Start("pictures").ok());
  request.mutable_wait()->set_seconds(30);
  const std::string robot = server_.Token(Role::kRobot);
  const grpc::Status first = streams_->GetLatest(ClientCall(robot).context(), request, &item);
  ASSERT_TRUE(first.ok()) << first.error_message();
  EXPECT_EQ(648u * 483, item.payload().size());
  request.set_after_seq(item.seq() + 3);
  pb::StreamItem later;
  ASSERT_TRUE(streams_->GetLatest(ClientCall(robot).context(), request, &later).ok());
  EXPECT_GT(later.seq(), item.seq() + 3);
  request.set_codec(pb::CODEC_RVL);
  const grpc::Status wrong = streams_->GetLatest(ClientCall(robot).context(), request, &later);
  EXPECT_EQ(grpc::StatusCode::INVALID_ARGUMENT, wrong.error_code());
  EXPECT_THAT(wrong.error_message(), HasSubstr("CODEC_JPEG, CODEC_RAW"));
}

TEST_F(DepthStream, StreamsAreListedAndBelongToWhoeverOpenedThem) {
  Create(PictureSpec(50));
  ASSERT_TRUE(Start("pictures").ok());
  StreamClient client(server_.Connect(), operator_, {Wish(1, "pictures/left"), Wish(2, "no/such")});
  pb::StreamItem item;
  ASSERT_TRUE(client.Take(&item));
  pb::ListStreamsResponse list;
  ASSERT_TRUE(
      streams_->ListStreams(ClientCall(operator_).context(), pb::ListStreamsRequest(), &list).ok());
  ASSERT_EQ(1, list.streams_size());
  EXPECT_EQ("pictures/left", list.streams(0).stream());
  EXPECT_EQ(pb::STREAM_KIND_GREY_PICTURE, list.streams(0).kind());
  EXPECT_EQ(648u, list.streams(0).width());
  EXPECT_EQ(1u, list.streams(0).subscribers());
  EXPECT_THAT(client.notices(), ::testing::Contains(HasSubstr("no running sequence")));

  pb::AckRequest ack;
  ack.set_stream_id(client.stream_id());
  pb::AckResponse acked;
  EXPECT_TRUE(streams_->Ack(ClientCall(operator_).context(), ack, &acked).ok());
  EXPECT_EQ(grpc::StatusCode::NOT_FOUND,
            streams_->Ack(ClientCall(engineer_).context(), ack, &acked).error_code());
}

TEST_F(DepthStream, AStreamEndsWhenItsSessionIsRevoked) {
  Create(PictureSpec(50));
  ASSERT_TRUE(Start("pictures").ok());
  const std::string token = server_.Token(Role::kViewer);
  StreamClient client(server_.Connect(), token, {Wish(1, "pictures/left")});
  pb::StreamItem item;
  ASSERT_TRUE(client.Take(&item));
  auto session = pb::SessionService::NewStub(channel_);
  pb::LogoutResponse out;
  ASSERT_TRUE(session->Logout(ClientCall(token).context(), pb::LogoutRequest(), &out).ok());
  while (client.Read(&item)) {
  }
  EXPECT_EQ(grpc::StatusCode::UNAUTHENTICATED, client.Finish().error_code());
}

}  // namespace
}  // namespace vs::test
