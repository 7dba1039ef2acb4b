// Our driver against the fake camera that comes with Aravis: a device that we did not write.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "engine/camera/gvcp.h"
#include "tests/engine/camera/camera_watch.h"
#include "tests/support/child_process.h"

namespace vs::test {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;
using namespace std::chrono_literals;

std::unique_ptr<ChildProcess> StartFakeCamera() {
  auto process = ChildProcess::Start({"arv-fake-gv-camera-0.8", "-i", "127.0.0.1", "-s", "GV01"});
  EXPECT_TRUE(process.has_value()) << process.error().ToString();
  return process ? std::move(*process) : nullptr;
}

TEST(GevFakeCamera, StreamsBySerialNumberAndByAddress) {
  const auto fake = StartFakeCamera();
  for (const char* uri : {"gev:GV01", "gev-ip:127.0.0.1"}) {
    CameraWatch watch(uri);
    ASSERT_TRUE(watch.Start());
    ASSERT_TRUE(watch.WaitForFrames(50)) << watch.Describe();
    const FramePtr frame = watch.LastFrame();
    EXPECT_EQ(frame->camera, "GV01");
    EXPECT_EQ(frame->image.width(), 512);
    EXPECT_EQ(frame->image.height(), 512);
    EXPECT_GT(frame->capture_ns, 0);
    EXPECT_LE(frame->capture_ns, frame->arrival_ns);
    const CameraStats stats = watch.camera().Stats();
    EXPECT_EQ(stats.state, CameraState::kStreaming);
    EXPECT_EQ(stats.incomplete, 0u);
    EXPECT_EQ(stats.rejected_stale, 0u);
    EXPECT_THAT(stats.model, HasSubstr("Aravis Fake"));
    EXPECT_EQ(stats.packet_bytes, 8192);
    EXPECT_GT(stats.socket_buffer_got_bytes, 0);
  }
}

}  // namespace
}  // namespace vs::test
