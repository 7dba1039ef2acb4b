#include "engine/camera/camera_hub.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/engine/camera/scripted_camera.h"

namespace vs::test {
namespace {

using ::testing::HasSubstr;

// The camera that was made last, and how many there are.
ScriptedCamera* latest = nullptr;
std::atomic<int> alive = 0;

struct Counted {
  Counted() { ++alive; }
  ~Counted() { --alive; }
};

class CountedCamera final : public CameraSource {
 public:
  explicit CountedCamera(const CameraUri& uri) : camera_(uri) { latest = &camera_; }

  Status Start(FrameSink sink) override { return camera_.Start(std::move(sink)); }
  void Stop() override { camera_.Stop(); }
  Status Trigger() override { return camera_.Trigger(); }
  Result<std::vector<FeatureInfo>> Features() override { return camera_.Features(); }
  Result<FeatureValue> GetFeature(const std::string& name) override {
    return camera_.GetFeature(name);
  }
  Result<FeatureValue> SetFeature(const std::string& name, const FeatureValue& value) override {
    return camera_.SetFeature(name, value);
  }
  CameraStats Stats() const override { return camera_.Stats(); }
  bool Recorded() const override { return camera_.Recorded(); }

 private:
  Counted counted_;
  ScriptedCamera camera_;
};

VS_REGISTER_CAMERA("script", [](const CameraUri& uri) -> Result<std::unique_ptr<CameraSource>> {
  return std::make_unique<CountedCamera>(uri);
});

CameraUri Uri(std::string_view text) { return CameraUri::Parse(text).value(); }

FrameSink CountInto(int& count) {
  return [&count](const FramePtr&) { ++count; };
}

TEST(CameraHub, GivesEveryPictureToEveryUser) {
  CameraHub hub;
  const auto one = hub.Acquire(Uri("script:a")).value();
  const auto two = hub.Acquire(Uri("script:a")).value();
  int seen_by_one = 0;
  int seen_by_two = 0;
  ASSERT_TRUE(one->Start(CountInto(seen_by_one)).ok());
  latest->Deliver(1, 0);
  ASSERT_TRUE(two->Start(CountInto(seen_by_two)).ok());
  latest->Deliver(2, 1);
  one->Stop();
  latest->Deliver(3, 2);
  two->Stop();
  latest->Deliver(4, 3);
  EXPECT_EQ(seen_by_one, 2);
  EXPECT_EQ(seen_by_two, 2);
  EXPECT_EQ(latest->starts(), 1);
}

TEST(CameraHub, OpensACameraOnceAndClosesItWithTheLastUser) {
  {
    CameraHub hub;
    auto one = hub.Acquire(Uri("script:a")).value();
    auto two = hub.Acquire(Uri("script:a")).value();
    EXPECT_EQ(alive, 1);
    ASSERT_EQ(hub.List().size(), 1u);
    EXPECT_EQ(hub.List()[0].uri, "script:a");
    one.reset();
    EXPECT_EQ(alive, 1);
    two.reset();
    EXPECT_TRUE(hub.List().empty());
  }
  EXPECT_EQ(alive, 0);
}

TEST(CameraHub, AUserThatGoesWithoutStoppingGetsNoMorePictures) {
  CameraHub hub;
  const auto stays = hub.Acquire(Uri("script:a")).value();
  int seen = 0;
  {
    const auto goes = hub.Acquire(Uri("script:a")).value();
    ASSERT_TRUE(goes->Start(CountInto(seen)).ok());
    latest->Deliver(1, 0);
  }
  latest->Deliver(2, 1);
  EXPECT_EQ(seen, 1);
}

TEST(CameraHub, FindsACameraWithOptionsByItsPlainName) {
  CameraHub hub;
  const auto configured = hub.Acquire(Uri("script:a?Width=640")).value();
  EXPECT_TRUE(hub.Acquire(Uri("script:a")).has_value());
  EXPECT_TRUE(hub.Acquire(Uri("script:a?Width=640")).has_value());
  EXPECT_EQ(alive, 1);
}

TEST(CameraHub, RefusesOtherOptionsForACameraInUse) {
  CameraHub hub;
  const auto configured = hub.Acquire(Uri("script:a?Width=640")).value();
  const auto other = hub.Acquire(Uri("script:a?Width=320"));
  ASSERT_FALSE(other.has_value());
  EXPECT_EQ(other.error().code(), StatusCode::kFailedPrecondition);
  EXPECT_THAT(other.error().message(), HasSubstr("script:a?Width=640"));
}

TEST(CameraHub, SomebodyWhoLooksAtACameraDoesNotKeepItFromItsUser) {
  CameraHub hub;
  const auto looking = hub.Acquire(Uri("script:a")).value();
  const auto using_it = hub.Acquire(Uri("script:a?Width=320"));
  ASSERT_TRUE(using_it.has_value());
  ASSERT_EQ(hub.List().size(), 1u);
  EXPECT_EQ(hub.List()[0].uri, "script:a?Width=320");
}

TEST(CameraHub, GivesEveryUserOfARecordingItsOwn) {
  CameraHub hub;
  const auto one = hub.Acquire(Uri("script:a?recorded=true")).value();
  const auto two = hub.Acquire(Uri("script:a?recorded=true")).value();
  EXPECT_EQ(alive, 2);
}

TEST(CameraHub, PassesTheErrorOfADriverOn) {
  CameraHub hub;
  EXPECT_EQ(hub.Acquire(Uri("nothing:a")).error().code(), StatusCode::kNotFound);
  const auto broken = hub.Acquire(Uri("script:broken")).value();
  int seen = 0;
  EXPECT_EQ(broken->Start(CountInto(seen)).code(), StatusCode::kUnavailable);
  EXPECT_EQ(broken->Start(CountInto(seen)).code(), StatusCode::kUnavailable);
}

TEST(CameraHub, StandsUsersThatComeAndGoWhilePicturesFlow) {
  CameraHub hub;
  const auto anchor = hub.Acquire(Uri("script:a")).value();
  ScriptedCamera* const camera = latest;
  std::atomic<bool> quit = false;
  std::thread pictures([&] {
    for (uint64_t i = 1; !quit; ++i) camera->Deliver(i, static_cast<int64_t>(i));
  });
  std::vector<std::thread> users;
  std::atomic<int> served = 0;
  users.reserve(4);
  for (int i = 0; i < 4; ++i) {
    users.emplace_back([&] {
      for (int j = 0; j < 100; ++j) {
        const auto camera_of_user = hub.Acquire(Uri("script:a")).value();
        std::atomic<int> seen = 0;
        EXPECT_TRUE(camera_of_user->Start([&seen](const FramePtr&) { ++seen; }).ok());
        while (seen == 0) std::this_thread::yield();
        camera_of_user->Stop();
        ++served;
      }
    });
  }
  for (std::thread& user : users) user.join();
  quit = true;
  pictures.join();
  EXPECT_EQ(served, 400);
}

TEST(CameraHub, FindsACameraByTheNameThatTheConfigurationGaveIt) {
  CameraHub hub;
  ASSERT_TRUE(hub.Name("left", Uri("script:a?Gain=3")).ok());
  EXPECT_FALSE(hub.Name("left", Uri("script:b")).ok());
  const auto named = hub.Acquire(Uri("camera:left")).value();
  EXPECT_EQ(1, alive);
  const auto same = hub.Acquire(Uri("script:a?Gain=3")).value();
  EXPECT_EQ(1, alive);
  EXPECT_EQ("script:a?Gain=3", hub.List().at(0).uri);
  const Status unknown = hub.Acquire(Uri("camera:right")).error();
  EXPECT_EQ(StatusCode::kNotFound, unknown.code());
  EXPECT_THAT(unknown.message(), HasSubstr("there are: left"));
}

}  // namespace
}  // namespace vs::test
