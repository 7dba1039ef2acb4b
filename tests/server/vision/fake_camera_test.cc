// The whole server with the fake camera that comes with Aravis: a GenICam device that we did not
// write. Its features and its pictures reach a client by the real API.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "visionserver/v1/camera.grpc.pb.h"

#include "engine/camera/gvcp.h"
#include "tests/server/vision/vision_fixture.h"
#include "tests/support/child_process.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

namespace pb = visionserver::v1;
using namespace std::chrono_literals;
using ::testing::Contains;
using ::testing::HasSubstr;

// Stands before the server, so that it goes after it: to close a camera that is gone takes seconds.
class Device {
 protected:
  Device() {
    auto started = ChildProcess::Start({"arv-fake-gv-camera-0.8", "-i", "127.0.0.1", "-s", "GV01"});
    EXPECT_TRUE(started.has_value()) << started.error().ToString();
    if (started) process_ = std::move(*started);
    EXPECT_TRUE(WaitUntil([] { return IdentifyGevCamera("127.0.0.1", 300ms).has_value(); }));
  }

  std::unique_ptr<ChildProcess> process_;
};

class FakeCamera : protected Device, public VisionTest {
 protected:
  FakeCamera() : VisionTest({.config = "camera { id: \"fake\" uri: \"gev-ip:127.0.0.1\" }"}) {}

  pb::Value Get(const std::string& feature) {
    pb::GetFeaturesRequest request;
    request.set_id("fake");
    request.add_names(feature);
    pb::GetFeaturesResponse response;
    const grpc::Status status =
        cameras_->GetFeatures(ClientCall(engineer_).context(), request, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response.values_size() == 1 ? response.values(0).value() : pb::Value();
  }
  grpc::Status Set(const std::string& feature, int64_t value, pb::SetFeaturesResponse* response) {
    pb::SetFeaturesRequest request;
    request.set_id("fake");
    pb::FeatureValue* one = request.add_values();
    one->set_name(feature);
    one->mutable_value()->set_int_value(value);
    return cameras_->SetFeatures(ClientCall(engineer_).context(), request, response);
  }

  const std::unique_ptr<pb::CameraService::Stub> cameras_ = pb::CameraService::NewStub(channel_);
};

TEST_F(FakeCamera, ListsReadsAndSetsItsFeatures) {
  pb::ListFeaturesRequest request;
  request.set_id("fake");
  pb::ListFeaturesResponse listed;
  const grpc::Status status =
      cameras_->ListFeatures(ClientCall(engineer_).context(), request, &listed);
  ASSERT_TRUE(status.ok()) << status.error_message();
  std::vector<std::string> names;
  for (const pb::FeatureInfo& feature : listed.features()) {
    names.push_back(feature.name());
    if (feature.name() == "Width") {
      EXPECT_EQ(pb::FEATURE_TYPE_INTEGER, feature.type());
      EXPECT_TRUE(feature.writable());
      EXPECT_TRUE(feature.has_max());
    } else if (feature.name() == "PixelFormat") {
      EXPECT_EQ(pb::FEATURE_TYPE_ENUMERATION, feature.type());
      EXPECT_THAT(feature.choices(), Contains("Mono8"));
    }
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"Width", "PixelFormat", "ExposureTimeAbs"}));

  EXPECT_EQ(512, Get("Width").int_value());
  EXPECT_EQ("Mono8", Get("PixelFormat").string_value());
  pb::SetFeaturesResponse set;
  ASSERT_TRUE(Set("Width", 256, &set).ok());
  ASSERT_EQ(1, set.values_size());
  EXPECT_EQ(256, set.values(0).value().int_value());
  // Each call finds the camera free, though the one before has only just let go of it.
  for (int i = 0; i < 10; ++i) EXPECT_EQ(256, Get("Width").int_value()) << i;

  const grpc::Status refused = Set("Width", 1'000'000, &set);
  EXPECT_EQ(grpc::StatusCode::OUT_OF_RANGE, refused.error_code());
  EXPECT_THAT(refused.error_message(), HasSubstr("1000000 is not a whole number from"));
}

TEST_F(FakeCamera, ShowsItsPicturesToAClientAndFollowsItsFeatures) {
  SequenceSpec spec;
  spec.id = "see";
  spec.blocks = {{"camera", "Camera", {{"address", std::string("camera:fake")}}},
                 {"publish", "Publish", {{"stream", std::string("picture")}}}};
  spec.connections = {{"camera", "image", "publish", "value"}};
  Create(spec);
  const grpc::Status started = Start("see");
  ASSERT_TRUE(started.ok()) << started.error_message();

  pb::Subscription wish = Wish(1, "see/picture");
  wish.set_codec(pb::CODEC_RAW);
  StreamClient client(server_.Connect(), operator_, {wish});
  pb::StreamItem item;
  uint64_t last_source_number = 0;
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(client.Take(&item));
    EXPECT_EQ(512U, item.header().width());
    EXPECT_EQ(512U, item.header().height());
    EXPECT_EQ(512U * 512U, item.payload().size());
    EXPECT_GT(item.header().capture_ns(), 0);
    EXPECT_GT(item.header().source_frame_number(), last_source_number);
    last_source_number = item.header().source_frame_number();
  }

  pb::SetFeaturesResponse set;
  const grpc::Status narrowed = Set("Width", 256, &set);
  ASSERT_TRUE(narrowed.ok()) << narrowed.error_message();
  do {
    ASSERT_TRUE(client.Take(&item));
  } while (item.header().width() == 512);
  EXPECT_EQ(256U, item.header().width());
  EXPECT_EQ(256U * 512U, item.payload().size());
  EXPECT_EQ(pb::SEQUENCE_RUN_STATE_RUNNING, State("see").state());
}

}  // namespace
}  // namespace vs::test
