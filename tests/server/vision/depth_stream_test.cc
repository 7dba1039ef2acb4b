// The main job over the real API: pictures in, maps out, on every client's screen.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/core/topic.h"
#include "tests/server/streams/published.h"
#include "tests/server/vision/vision_fixture.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

namespace pb = visionserver::v1;
using ::testing::HasSubstr;

// A simulated pair -> matcher -> stream "depth". Small and coarse, for a busy machine.
SequenceSpec DepthSpec() {
  SequenceSpec spec;
  spec.id = "stereo_depth";
  spec.blocks = {
      {"source", "SimulatedStereo", {}},
      {"match", "SgmStereo", {{"num_disparities", int64_t{32}}}},
      {"publish", "Publish", {{"stream", std::string("depth")}}},
  };
  spec.connections = {{"source", "pair", "match", "pair"},
                      {"match", "disparity", "publish", "value"}};
  return spec;
}

using DepthStream = VisionTest;

TEST_F(DepthStream, AClientGetsDisparityMapsOfARunningSequence) {
  Create(DepthSpec());
  const grpc::Status started = Start("stereo_depth");
  ASSERT_TRUE(started.ok()) << started.error_message();
  StreamClient client(server_.Connect(), operator_, {Wish(1, "stereo_depth/depth")});
  uint64_t last = 0;
  for (int i = 0; i < 3; ++i) {
    pb::StreamItem item;
    ASSERT_TRUE(client.Take(&item));
    EXPECT_EQ(1u, item.subscription_id());
    EXPECT_GT(item.seq(), last);
    last = item.seq();
    EXPECT_EQ(pb::STREAM_KIND_DISPARITY, item.header().kind());
    EXPECT_EQ(pb::CODEC_RVL, item.header().codec());
    EXPECT_FALSE(UnpackDisparity(item).empty());
    EXPECT_GT(item.header().frame_number(), 0u);
  }
  EXPECT_EQ(pb::SEQUENCE_RUN_STATE_RUNNING, State("stereo_depth").state());
  EXPECT_TRUE(Stop("stereo_depth").ok());
}

}  // namespace
}  // namespace vs::test
