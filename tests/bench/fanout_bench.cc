// What a live depth stream costs for many clients: server processor time per frame and client,
// memory, and how old frames are when they arrive. The clients run in a process of their own, each
// on a connection of its own, and acknowledge every item.
//
//   fanout_bench [--codec raw|rvl] [--seconds 5] [--tls] [--json]
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/str.h"
#include "engine/core/block.h"
#include "server/convert/sequence.h"
#include "tests/server/streams/published.h"
#include "tests/server/vision/vision_fixture.h"
#include "tests/support/child_process.h"

namespace vs::test {
namespace {

namespace pb = visionserver::v1;

constexpr int kWidth = 648;
constexpr int kHeight = 483;
constexpr double kFps = 30;

// Publishes prepared maps at a fixed rate, so that nothing but the fan-out costs anything.
class BenchMap final : public Block {
 public:
  Out<DisparityMap> map{this, "map", "A prepared map."};

  Status Start() override {
    for (int seed = 0; seed < 6; ++seed) {
      maps_.push_back(std::make_shared<const DisparityMap>(MapOf(kWidth, kHeight, seed)));
    }
    pacer_ = std::jthread([this](const std::stop_token& stop) {
      const SystemClock clock;
      for (int64_t due_ns = clock.MonotonicNs(); !stop.stop_requested();
           due_ns += static_cast<int64_t>(1e9 / kFps)) {
        const int64_t left_ns = due_ns - clock.MonotonicNs();
        if (left_ns > 0) std::this_thread::sleep_for(std::chrono::nanoseconds(left_ns));
        due_ = true;
        Wake();
      }
    });
    return Status();
  }
  bool Ready() override { return due_; }
  Status Run() override {
    due_ = false;
    frame().capture_ns = SystemClock().MonotonicNs();
    map.Set(maps_[frame().number % maps_.size()]);
    return Status();
  }
  void Stop() override { pacer_ = std::jthread(); }

 private:
  std::vector<std::shared_ptr<const DisparityMap>> maps_;
  std::atomic<bool> due_ = false;
  std::jthread pacer_;
};
VS_REGISTER_BLOCK(BenchMap, {.category = "Test", .doc = "Prepared maps at a fixed rate."});

struct Scenario {
  const char* name;
  int quick;
  int slow;     // takes 200 ms for each item
  int stalled;  // reads one item and then no more
};

struct Options {
  std::string codec = "rvl";
  int seconds = 5;
  bool tls = false;
  bool json = false;
};

double CpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

int64_t ResidentMb() {
  std::ifstream file("/proc/self/statm");
  int64_t pages = 0;
  file >> pages >> pages;
  return pages * sysconf(_SC_PAGESIZE) >> 20;
}

double PercentileMs(std::vector<int64_t>& ages_ns, double share) {
  if (ages_ns.empty()) return 0;
  std::sort(ages_ns.begin(), ages_ns.end());
  return static_cast<double>(
             ages_ns[static_cast<size_t>(share * static_cast<double>(ages_ns.size() - 1))]) /
         1e6;
}

// ---- the clients' process: TARGET TOKEN CERTIFICATE CODEC SECONDS QUICK SLOW STALLED

struct Received {
  std::vector<int64_t> ages_ns;
  uint64_t bytes = 0;
};

void RunClient(std::shared_ptr<grpc::Channel> channel, const std::string& token, pb::Codec codec,
               int64_t end_ns, int sleep_ms, bool stalled, Received* received) {
  pb::Subscription wanted = Wish(1, "bench/map", 2);
  wanted.set_codec(codec);
  StreamClient client(std::move(channel), token, {wanted});
  const SystemClock clock;
  pb::StreamItem item;
  while (clock.MonotonicNs() < end_ns && client.Read(&item)) {
    received->ages_ns.push_back(clock.MonotonicNs() - item.header().capture_ns());
    received->bytes += item.payload().size();
    if (stalled) {
      std::this_thread::sleep_for(std::chrono::nanoseconds(end_ns - clock.MonotonicNs()));
      return;
    }
    if (sleep_ms > 0) std::this_thread::sleep_for(std::chrono::milliseconds(sleep_ms));
    client.Ack(item);
  }
}

int RunClients(char** arguments) {
  const std::string target = arguments[0];
  const std::string token = arguments[1];
  const std::string certificate = arguments[2];
  const pb::Codec codec = std::strcmp(arguments[3], "raw") == 0 ? pb::CODEC_RAW : pb::CODEC_RVL;
  const SystemClock clock;
  const int64_t end_ns = clock.MonotonicNs() + int64_t{std::atoi(arguments[4])} * 1'000'000'000;
  const int counts[] = {std::atoi(arguments[5]), std::atoi(arguments[6]), std::atoi(arguments[7])};
  std::vector<std::unique_ptr<Received>> received;
  std::vector<std::thread> threads;
  for (int kind = 0; kind < 3; ++kind) {
    for (int i = 0; i < counts[kind]; ++i) {
      grpc::ChannelArguments own;
      own.SetInt("bench.connection", static_cast<int>(threads.size()));
      own.SetMaxReceiveMessageSize(-1);
      std::shared_ptr<grpc::ChannelCredentials> credentials = grpc::InsecureChannelCredentials();
      if (certificate != "-") {
        std::ifstream file(certificate);
        credentials =
            grpc::SslCredentials({.pem_root_certs = {std::istreambuf_iterator<char>(file), {}}});
        own.SetSslTargetNameOverride("localhost");
      }
      auto channel = grpc::CreateCustomChannel(target, credentials, own);
      received.push_back(std::make_unique<Received>());
      threads.emplace_back(RunClient, channel, token, codec, end_ns, kind == 1 ? 200 : 0, kind == 2,
                           received.back().get());
    }
  }
  for (std::thread& thread : threads) thread.join();
  size_t index = 0;
  for (int kind = 0; kind < 3; ++kind) {
    std::vector<int64_t> ages;
    uint64_t bytes = 0;
    for (int i = 0; i < counts[kind]; ++i, ++index) {
      ages.insert(ages.end(), received[index]->ages_ns.begin(), received[index]->ages_ns.end());
      bytes += received[index]->bytes;
    }
    const size_t items = ages.size();
    const double p50 = PercentileMs(ages, 0.5);
    const double p99 = PercentileMs(ages, 0.99);
    const double max = PercentileMs(ages, 1);
    std::printf("%zu %llu %.3f %.3f %.3f\n", items, static_cast<unsigned long long>(bytes), p50,
                p99, max);
  }
  return EXIT_SUCCESS;
}

// ---- the server's process

struct Figures {
  size_t items = 0;
  uint64_t bytes = 0;
  double p50_ms = 0, p99_ms = 0, max_ms = 0;
};

void Measure(TestServer& server, const std::string& token, const Options& options,
             const Scenario& scenario) {
  const std::string certificate =
      options.tls ? (server.data_dir() / "tls" / "server.crt").string() : "-";
  const double cpu_before = CpuSeconds();
  const auto clients =
      RunProcess({"/proc/self/exe", "--clients", server.Target(), token, certificate, options.codec,
                  std::to_string(options.seconds), std::to_string(scenario.quick),
                  std::to_string(scenario.slow), std::to_string(scenario.stalled)},
                 {}, std::chrono::minutes(5));
  const double cpu = CpuSeconds() - cpu_before;
  if (!clients || clients->exit_code != 0) {
    std::fprintf(stderr, "the clients failed: %s\n",
                 clients ? clients->error_output.c_str() : clients.error().ToString().c_str());
    return;
  }
  Figures kinds[3];
  std::istringstream lines(clients->output);
  for (Figures& one : kinds) {
    lines >> one.items >> one.bytes >> one.p50_ms >> one.p99_ms >> one.max_ms;
  }
  const Figures& quick = kinds[0];
  const size_t items = quick.items + kinds[1].items + kinds[2].items;
  const double fps =
      static_cast<double>(quick.items) / std::max(scenario.quick, 1) / options.seconds;
  const double us_per_item = cpu * 1e6 / static_cast<double>(std::max<size_t>(items, 1));
  if (options.json) {
    std::printf(
        "{\"scenario\": \"%s\", \"codec\": \"%s\", \"tls\": %s, \"quick\": %d, \"slow\": "
        "%d, \"stalled\": %d, \"fps\": %.2f, \"age_p50_ms\": %.2f, \"age_p99_ms\": %.2f, "
        "\"slow_age_max_ms\": %.1f, \"server_us_per_item\": %.0f, \"server_cores\": %.2f, "
        "\"resident_mb\": %lld}\n",
        scenario.name, options.codec.c_str(), options.tls ? "true" : "false", scenario.quick,
        scenario.slow, scenario.stalled, fps, quick.p50_ms, quick.p99_ms, kinds[1].max_ms,
        us_per_item, cpu / options.seconds, static_cast<long long>(ResidentMb()));
  } else {
    std::printf(
        "%-24s %5.1f fps  age p50 %7.2f ms  p99 %7.2f ms  slow's age <= %6.1f ms  %6.0f us "
        "per item  %5.2f cores  %4lld MB\n",
        scenario.name, fps, quick.p50_ms, quick.p99_ms, kinds[1].max_ms, us_per_item,
        cpu / options.seconds, static_cast<long long>(ResidentMb()));
  }
  std::fflush(stdout);
}

int RunServer(const Options& options) {
  TestServer server(
      {.tls = options.tls, .config = "limits { unread_ms: 60000 connections_per_address: 1000 }"});
  SequenceSpec spec;
  spec.id = "bench";
  spec.blocks = {{"source", "BenchMap", {}},
                 {"publish", "Publish", {{"stream", std::string("map")}}}};
  spec.connections = {{"source", "map", "publish", "value"}};
  const std::string token = server.Token(Role::kEngineer);
  const auto sequences = pb::SequenceService::NewStub(server.Connect());
  pb::CreateSequenceRequest create;
  create.set_id(spec.id);
  *create.mutable_spec() = ToProto(spec);
  pb::Sequence created;
  pb::StartSequenceRequest start;
  start.set_id(spec.id);
  pb::SequenceState state;
  if (!sequences->CreateSequence(ClientCall(token).context(), create, &created).ok() ||
      !sequences->StartSequence(ClientCall(token).context(), start, &state).ok()) {
    std::fprintf(stderr, "the sequence does not start\n");
    return EXIT_FAILURE;
  }
  if (!options.json) {
    std::printf("%dx%d disparity at %.0f fps, %s%s, %d s each\n", kWidth, kHeight, kFps,
                options.codec.c_str(), options.tls ? ", TLS" : "", options.seconds);
  }
  for (const Scenario& scenario :
       {Scenario{"1 client", 1, 0, 0}, Scenario{"8 clients", 8, 0, 0},
        Scenario{"32 clients", 32, 0, 0}, Scenario{"64 clients", 64, 0, 0},
        Scenario{"8 and a slow one", 8, 1, 0}, Scenario{"8 and 32 stalled", 8, 0, 32}}) {
    Measure(server, token, options, scenario);
  }
  return EXIT_SUCCESS;
}

int Main(int argument_count, char** arguments) {
  if (argument_count == 10 && std::strcmp(arguments[1], "--clients") == 0) {
    return RunClients(arguments + 2);
  }
  Options options;
  for (int i = 1; i < argument_count; ++i) {
    const std::string argument = arguments[i];
    if (argument == "--tls") {
      options.tls = true;
    } else if (argument == "--json") {
      options.json = true;
    } else if (argument == "--codec" && i + 1 < argument_count) {
      options.codec = arguments[++i];
    } else if (argument == "--seconds" && i + 1 < argument_count) {
      options.seconds = std::max(1, std::atoi(arguments[++i]));
    } else {
      std::fprintf(stderr, "fanout_bench [--codec raw|rvl] [--seconds N] [--tls] [--json]\n");
      return 2;
    }
  }
  return RunServer(options);
}

}  // namespace
}  // namespace vs::test

int main(int argument_count, char** arguments) { return vs::test::Main(argument_count, arguments); }
