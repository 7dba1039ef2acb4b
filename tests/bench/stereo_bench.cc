// How fast the matcher is, beside OpenCV's in the same run.
//
//   stereo_bench [--case SUBSTRING ...] [--rounds N] [--no-peers] [--json]
//
// A case is SIZE_dRANGE_WHAT_tTHREADS: WHAT is a preset, or nK for K directions of plain census
// without filters. All matchers of a case take turns, so that what disturbs the machine disturbs
// all of them. OpenCV's pictures are widened by the range, so that all compute the same columns.
// Prints median and least milliseconds and how many times each peer's median ours is.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>

#include "engine/base/str.h"
#include "engine/calibration/rectifier.h"
#include "engine/sim/demo_rig.h"
#include "engine/sim/ideal_stereo.h"
#include "engine/stereo/cpu/cpu_matcher.h"
#include "engine/stereo/depth.h"
#include "engine/stereo/sgm_presets.h"
#include "engine/stereo/stereo_matcher.h"
#include "proto/wire/rvl.h"
#include "proto/wire/zstd.h"
#include "tests/bench/opencv_peers.h"
#include "tests/bench/sgm_options.h"

namespace vs::test {
namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  std::vector<std::string> cases;
  int rounds = 9;
  bool peers = true;
  bool json = false;
};

// Somebody who does a case's work, and how long it took him each time.
struct Runner {
  std::string matcher;
  std::string isa;
  std::function<double()> run;                               // gives milliseconds
  std::function<size_t()> bytes = [] { return size_t{0}; };  // working memory; 0: not known
  std::vector<double> ms = {};

  double Median() {
    std::sort(ms.begin(), ms.end());
    return ms[ms.size() / 2];
  }
};

double MillisecondsOf(const std::function<void()>& work) {
  const auto begin = Clock::now();
  work();
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

void PrintCase(const std::string& name, std::vector<Runner>& runners, bool json) {
  const double ours = runners.front().Median();
  for (Runner& runner : runners) {
    const double median = runner.Median();
    if (json) {
      std::printf("%s\n", nlohmann::json{{"case", name},
                                         {"matcher", runner.matcher},
                                         {"isa", runner.isa},
                                         {"median_ms", median},
                                         {"min_ms", runner.ms.front()},
                                         {"ratio", median / ours},
                                         {"working_bytes", runner.bytes()}}
                              .dump()
                              .c_str());
    } else {
      std::printf("%-32s %-12s %-9s median %9.2f ms   min %9.2f ms   x %6.2f", name.c_str(),
                  runner.matcher.c_str(), runner.isa.c_str(), median, runner.ms.front(),
                  median / ours);
      const auto bytes = static_cast<double>(runner.bytes());
      if (bytes > 0) std::printf("   %6.1f MB", bytes * 1e-6);
      std::printf("\n");
    }
  }
  std::fflush(stdout);
}

void TakeTurns(const std::string& name, std::vector<Runner> runners, const Options& options) {
  for (Runner& runner : runners) runner.run();  // warm
  for (int round = 0; round < options.rounds; ++round) {
    for (Runner& runner : runners) {
      // The slow ones need not be asked so often.
      if (!runner.ms.empty() && runner.ms.back() > 1000 && round % 4 != 0) continue;
      runner.ms.push_back(runner.run());
    }
  }
  PrintCase(name, runners, options.json);
}

class Bench {
 public:
  explicit Bench(Options options) : options_(std::move(options)) {
    for (const cpu::Kernels* kernels :
         {cpu::Avx512Kernels(), cpu::Avx2Kernels(), cpu::PortableKernels()}) {
      if (kernels != nullptr) kernels_.push_back(kernels);
    }
    for (const int binning : {2, 1}) {
      const StereoFrame pair = sim::IdealStereo({.binning = binning}).Capture(0, 1, pool_);
      pairs_[binning == 2 ? "648x482" : "1296x966"] = {
          Cropped(pair.left->image, binning == 2 ? 482 : 966),
          Cropped(pair.right->image, binning == 2 ? 482 : 966)};
    }
  }

  void Matching() {
    for (const auto& [size, pair] : pairs_) {
      for (const int range : {64, 128, 192, 196, 256}) {
        for (const std::string what : {"quality", "strict", "lean", "eight", "paper", "single_pass",
                                       "n1", "n4", "n7", "n8"}) {
          for (const int threads : Threads()) {
            MatchCase(Str(size, "_d", range, "_", what, "_t", threads), pair, range, what, threads);
          }
        }
      }
    }
  }

  void Rectification() {
    const StereoRig rig = sim::DemoRig();
    cv::setNumThreads(1);
    for (const int height : {483, 966}) {
      const int width = height == 483 ? 648 : 1296;
      const std::string name = Str(width, "x", height, "_rectify_t1");
      if (!Wanted(name)) continue;
      StereoFrame raw;
      for (auto* side : {&raw.left, &raw.right}) {
        auto frame = std::make_shared<Frame>();
        frame->image = GreyImage(pool_, width, height);
        frame->image.Fill(100);
        *side = frame;
      }
      std::vector<Runner> runners;
      const auto add = [&](const char* what, const RectifyOptions& rectify) {
        const auto rectifier = Rectifier::Make(rig, width, height, rectify).value();
        runners.push_back({what, "", [this, rectifier, &raw] {
                             return MillisecondsOf([&] { rectifier.Rectify(raw, pool_).value(); });
                           }});
      };
      add("fixed", {});
      add("float", {.exact_maps = true});
      add("half", {.half_size = true});
      add("cubic", {.interpolation = Interpolation::kCubic});
      const OpenCvRemap opencv(rig.left, width, height);
      if (options_.peers) {
        runners.push_back({"opencv_remap", "", [&] {
                             return opencv.Milliseconds(raw.left->image) +
                                    opencv.Milliseconds(raw.right->image);
                           }});
      }
      TakeTurns(name, runners, options_);
    }
  }

  void DepthAndCodecs() {
    const auto& [left, right] = pairs_.at("648x482");
    const auto matcher = *StereoMatchers::Get().Make("cpu");
    DisparityMap map = matcher->Match(left, right, {.num_disparities = 128}, 1, pool_).value();
    map.geometry = sim::IdealGeometry(2);
    const DepthMap depth = DepthFromDisparity(map, pool_).value();
    const size_t pixels = static_cast<size_t>(left.width()) * left.height();
    std::vector<uint8_t> packed(wire::RvlBound(pixels));
    std::vector<uint8_t> zipped(wire::ZstdPacker::Bound(packed.size()));
    wire::ZstdPacker zstd;
    size_t size = 0;
    const std::pair<std::string, std::function<void()>> works[] = {
        {"depth", [&] { DepthFromDisparity(map, pool_).value(); }},
        {"points", [&] { PointsFromDepth(depth, pool_).value(); }},
        {"rvl",
         [&] { size = wire::EncodeRvl(map.disparity.Row(0), pixels, 1, pixels * 2, packed); }},
        {"rvl_zstd", [&] {
           size = wire::EncodeRvl(map.disparity.Row(0), pixels, 1, pixels * 2, packed);
           zstd.Pack({packed.data(), size}, zipped);
         }}};
    for (const auto& [what, work] : works) {
      const std::string name = Str("648x482_", what, "_t1");
      if (!Wanted(name)) continue;
      TakeTurns(name, {{what, "", [&run = work] { return MillisecondsOf(run); }}}, options_);
    }
  }

 private:
  struct Pair {
    GreyImage left;
    GreyImage right;
  };

  GreyImage Cropped(const GreyImage& image, int height) {
    return GreyImage(image.buffer(), image.width(), height, image.stride_bytes());
  }
  static std::vector<int> Threads() {
    std::vector<int> counts;
    const int all = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    for (int n = 1; n < all; n *= 2) counts.push_back(n);
    counts.push_back(all);
    return counts;
  }
  bool Wanted(const std::string& name) const {
    if (options_.cases.empty()) return true;
    return std::any_of(options_.cases.begin(), options_.cases.end(), [&](const std::string& part) {
      return name.find(part) != std::string::npos;
    });
  }

  void MatchCase(const std::string& name, const Pair& pair, int range, const std::string& what,
                 int threads) {
    if (!Wanted(name)) return;
    SgmSettings settings =
        what[0] == 'n' ? PlainCensus(what[1] - '0') : ApplySgmPreset(what).value();
    settings.num_disparities = range;
    std::vector<Runner> runners;
    // Each case has matchers of its own, so that their memory is the case's.
    const auto add = [&](const std::string& name_of, const std::string& isa,
                         std::shared_ptr<StereoMatcher> matcher) {
      runners.push_back(
          {name_of, isa,
           [&, matcher] {
             return MillisecondsOf(
                 [&] { matcher->Match(pair.left, pair.right, settings, threads, pool_).value(); });
           },
           [matcher] { return matcher->WorkingBytes(); }});
    };
    for (const cpu::Kernels* kernels : kernels_) {
      add("cpu", kernels->name, *cpu::MakeCpuMatcher(kernels));
    }
    if (options_.peers) {
      add("reference", "", *StereoMatchers::Get().Make("reference"));
      for (const OpenCvPeer& peer : OpenCvPeers()) {
        runners.push_back({std::string(peer.name), "", [&] {
                             cv::setNumThreads(threads);
                             return RunOpenCvPeer(peer, pair.left, pair.right, range, pool_).ms;
                           }});
      }
    }
    TakeTurns(name, std::move(runners), options_);
  }

  const Options options_;
  BufferPool pool_;
  std::vector<const cpu::Kernels*> kernels_;
  std::map<std::string, Pair> pairs_;
};

int Main(int argc, char** argv) {
  Options options;
  bool no_peers = false;
  CLI::App app("How fast the matcher is, beside OpenCV's in the same run.", "stereo_bench");
  app.add_option("--case", options.cases, "Only cases whose name contains this");
  app.add_option("--rounds", options.rounds)->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_flag("--no-peers", no_peers, "Without the reference and OpenCV");
  app.add_flag("--json", options.json, "One object for each line");
  CLI11_PARSE(app, argc, argv);
  options.peers = !no_peers;
  Bench bench(options);
  bench.Matching();
  bench.Rectification();
  bench.DepthAndCodecs();
  return 0;
}

}  // namespace
}  // namespace vs::test

int main(int argc, char** argv) { return vs::test::Main(argc, argv); }
