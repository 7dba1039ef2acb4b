// Clients that have stopped reading, next to others that go on.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/mutex.h"
#include "engine/core/block.h"
#include "tests/engine/core/test_blocks.h"
#include "tests/server/streams/published.h"
#include "tests/server/vision/vision_fixture.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

namespace pb = visionserver::v1;

constexpr int kStalled = 32;
constexpr int kReaders = 8;
constexpr uint32_t kWindow = 2;
constexpr uint64_t kItems = 12;

Mutex made_mutex;
std::vector<std::weak_ptr<const DisparityMap>> made VS_GUARDED_BY(made_mutex);

// Makes a map of each number, two of which are more than a connection holds.
class NumberToMap final : public Block {
 public:
  In<int64_t> number{this, "number", "Which map."};
  Out<DisparityMap> map{this, "map", "A map of noise."};

  Status Run() override {
    const auto noise =
        std::make_shared<const DisparityMap>(MapOf(200, 150, static_cast<int>(*number)));
    map.Set(noise);
    MutexLock lock(made_mutex);
    made.push_back(noise);
    return Status();
  }
};
VS_REGISTER_BLOCK(NumberToMap, {.category = "Test", .doc = "Makes maps."});

int64_t MapsInMemory() {
  MutexLock lock(made_mutex);
  return std::count_if(made.begin(), made.end(), [](const auto& map) { return !map.expired(); });
}

// A sequence whose frames come when the test wants them, so that the pace is the readers' own,
// however busy the machine. The server is told to put up with clients that do not read.
class StalledClients : public VisionTest {
 protected:
  StalledClients()
      : VisionTest({.config = "limits { unread_ms: 600000 streams_per_session: 40 }"}) {
    Probe& source = ProbeOf("source");
    source.ready = [this] { return counted_ < wanted_; };
    source.run = [this](const StepRun&) {
      ++counted_;
      return Status();
    };
    source.take_wake = [this](std::function<void()> wake) { wake_ = std::move(wake); };
    SequenceSpec spec = ChainSpec("maps", {});
    spec.blocks.push_back({"noise", "NumberToMap", {}});
    spec.blocks.push_back({"publish", "Publish", {{"stream", std::string("map")}}});
    spec.connections = {Wire("source.value", "noise.number"), Wire("noise.map", "publish.value")};
    Create(spec);
    EXPECT_TRUE(Start("maps").ok());
  }
  ~StalledClients() override {
    server_->vision().StopSequences();
    ClearProbes();
  }

  std::vector<std::unique_ptr<StreamClient>> Subscribe(int count) {
    pb::Subscription wanted = Wish(1, "maps/map", kWindow);
    wanted.set_codec(pb::CODEC_RAW);
    std::vector<std::unique_ptr<StreamClient>> clients;
    clients.reserve(static_cast<size_t>(count));
    for (int i = 0; i < count; ++i) {
      clients.push_back(
          std::make_unique<StreamClient>(server_.Connect(), operator_, std::vector{wanted}));
    }
    return clients;
  }
  void PublishOneMore() {
    ++wanted_;
    wake_();
  }

  std::atomic<uint64_t> wanted_ = 0;
  std::atomic<uint64_t> counted_ = 0;
  std::function<void()> wake_;
};

TEST_F(StalledClients, CostTheOthersNoItemAndTheServerNoMemory) {
  const auto stalled = Subscribe(kStalled);
  const auto readers = Subscribe(kReaders);
  pb::StreamItem item;
  for (uint64_t number = 1; number <= kItems; ++number) {
    PublishOneMore();
    for (const auto& reader : readers) {
      ASSERT_TRUE(reader->Take(&item));
      EXPECT_EQ(number, item.seq());
      EXPECT_EQ(0u, item.dropped());
    }
  }
  // The newest, those under way to the stalled ones (the same for all), and one in the sequence.
  EXPECT_TRUE(WaitUntil([] { return MapsInMemory() <= 2 + kWindow; })) << MapsInMemory();
  // What is there for a stalled client is what was under way when it stalled, then the newest.
  for (const auto& client : stalled) {
    uint64_t received = 0;
    do {
      ASSERT_TRUE(client->Take(&item));
      ++received;
    } while (item.seq() < kItems);
    EXPECT_LE(received, kWindow + 1);
  }
}

}  // namespace
}  // namespace vs::test
