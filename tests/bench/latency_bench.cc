// Where the time of a stereo frame goes, from the exposure of two GigE Vision cameras (simulated,
// with real packets) to the map that a client has unpacked. Each stage is from its own beginning to
// its own end; "wait" is what lies between the last block and the packing.
//
//   latency_bench [--frames 100] [--fps 5] [--json]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "tests/server/streams/published.h"
#include "tests/server/vision/demo.h"
#include "tests/server/vision/vision_fixture.h"
#include "tests/support/gevsim.h"
#include "tests/support/network_namespace.h"

namespace vs::test {
namespace {

namespace pb = visionserver::v1;

constexpr const char* kTotal = "TOTAL";

struct Options {
  int frames = 100;
  std::string fps = "5";
  bool json = false;
};

// Durations by stage, the stages in the order in which they were first seen.
class Budget {
 public:
  void Add(const std::string& stage, int64_t duration_ns) {
    if (!durations_ns_.contains(stage)) order_.push_back(stage);
    durations_ns_[stage].push_back(duration_ns);
  }

  void Print(bool json) {
    if (!json) std::printf("%-14s %10s %10s\n", "stage", "p50 ms", "p99 ms");
    // What runs beside the map is seen late, and not in every frame.
    std::stable_partition(order_.begin(), order_.end(),
                          [](const std::string& stage) { return stage != kTotal; });
    for (const std::string& stage : order_) {
      std::vector<int64_t>& all = durations_ns_[stage];
      std::sort(all.begin(), all.end());
      const auto at = [&all](double share) {
        return static_cast<double>(
                   all[static_cast<size_t>(share * static_cast<double>(all.size() - 1))]) /
               1e6;
      };
      std::printf(json ? "{\"stage\": \"%s\", \"p50_ms\": %.3f, \"p99_ms\": %.3f}\n"
                       : "%-14s %10.3f %10.3f\n",
                  stage.c_str(), at(0.5), at(0.99));
    }
  }

 private:
  std::vector<std::string> order_;
  std::map<std::string, std::vector<int64_t>> durations_ns_;
};

void Account(const pb::StreamItem& item, int64_t received_ns, int64_t unpacked_ns, Budget* budget) {
  const pb::FrameHeader& header = item.header();
  int64_t blocks_end_ns = 0;
  for (const pb::StageTiming& stage : header.timing()) {
    if (stage.stage() == "encode") budget->Add("wait", stage.start_ns() - blocks_end_ns);
    budget->Add(stage.stage(), stage.end_ns() - stage.start_ns());
    blocks_end_ns = std::max(blocks_end_ns, stage.end_ns());
  }
  budget->Add("send queue", item.sent_ns() - blocks_end_ns);
  budget->Add("network", received_ns - item.sent_ns());
  budget->Add("unpack", unpacked_ns - received_ns);
  budget->Add(kTotal, unpacked_ns - header.capture_ns());
}

int Fail(const std::string& what) {
  std::fprintf(stderr, "latency_bench: %s\n", what.c_str());
  return EXIT_FAILURE;
}

int Measure(const Options& options) {
  const auto cameras = StartGevSim({"--fps", options.fps});
  if (!cameras) return Fail(cameras.error().ToString());
  TestServer server;
  if (const Status demo = RestartAsDemo(&server); !demo.ok()) return Fail(demo.ToString());
  const std::string token = server.Token(Role::kOperator);

  const SystemClock clock;
  Budget budget;
  // A deadline holds for a whole stream: take a new one when it has passed.
  for (int frames = 0; frames < options.frames;) {
    StreamClient client(server.Connect(), token, {Wish(1, "stereo_depth/depth", 2)});
    pb::StreamItem item;
    while (frames < options.frames && client.Read(&item)) {
      const int64_t received_ns = clock.MonotonicNs();
      if (UnpackDisparity(item).empty()) return Fail("a map cannot be unpacked");
      Account(item, received_ns, clock.MonotonicNs(), &budget);
      client.Ack(item);
      ++frames;
    }
  }
  budget.Print(options.json);
  return EXIT_SUCCESS;
}

int Main(int argument_count, char** arguments) {
  Options options;
  for (int i = 1; i < argument_count; ++i) {
    const std::string argument = arguments[i];
    if (argument == "--json") {
      options.json = true;
    } else if (argument == "--frames" && i + 1 < argument_count) {
      options.frames = std::max(1, std::atoi(arguments[++i]));
    } else if (argument == "--fps" && i + 1 < argument_count) {
      options.fps = arguments[++i];
    } else {
      std::fprintf(stderr, "latency_bench [--frames N] [--fps N] [--json]\n");
      return 2;
    }
  }
  if (const auto reason = EnterOwnNetwork(argument_count, arguments)) {
    return Fail("needs a network of its own: " + *reason);
  }
  return Measure(options);
}

}  // namespace
}  // namespace vs::test

int main(int argument_count, char** arguments) { return vs::test::Main(argument_count, arguments); }
