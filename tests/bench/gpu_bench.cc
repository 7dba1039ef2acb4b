// How fast a GPU matches.
//
//   gpu_bench [--case SUBSTRING ...] [--device K] [--rounds N] [--json]
//
// A case is SIZE_dRANGE_WHAT: WHAT is nK for K directions of plain census without filters, or a
// preset. For each it prints medians over N frames:
//   stages    from the first kernel to the last, by the device's own clock
//   whole     from two pictures in ordinary memory to the map, by ours
//   fps       with two executors at once, frames of both together
// and beside them what would be left if nothing else mattered, in ms; the rates are nominal:
//   memory    each volume of costs and of sums written and read once
//   add       5.5 instructions for each two cells of each path, 64 a clock and multiprocessor
//   count     a bit count for each 32 bits of each cell's code, 16 a clock and multiprocessor
//   chain     the pixels of the longest line one after the other, 280 clocks each
// Where there is no GPU it says why and exits with 0.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "engine/base/str.h"
#include "engine/sim/ideal_stereo.h"
#include "engine/stereo/census.h"
#include "engine/stereo/sgm_presets.h"
#include "gpu/cuda_executor.h"
#include "gpu/devices.h"
#include "gpu/frame.h"
#include "tests/bench/sgm_options.h"

namespace vs::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kWarmFrames = 5;

struct Options {
  std::vector<std::string> cases;
  int device = 0;
  int rounds = 50;
  bool json = false;
};

struct Pair {
  std::string size;
  GreyImage left;
  GreyImage right;
};

struct Figures {
  double stages_ms = 0;
  double whole_ms = 0;
  double fps = 0;
  double memory_ms = 0;
  double add_ms = 0;
  double count_ms = 0;
  double chain_ms = 0;
  size_t device_bytes = 0;
};

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double MillisecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

// One executor that gets the same pair again and again.
class Lane {
 public:
  Lane(int device, const Pair& pair, const SgmSettings& settings) : pair_(pair) {
    executor_ = gpu::MakeCudaExecutor(device, {}).value();
    const Status prepared =
        executor_->Prepare({.settings = settings}, pair.left.width(), pair.left.height());
    if (!prepared.ok()) throw std::runtime_error(prepared.ToString());
    for (int k = 0; k < kWarmFrames; ++k) Frame();
  }

  void Frame() { executor_->Run(pair_.left, pair_.right, pool_).value(); }
  const gpu::Executor& executor() const { return *executor_; }

 private:
  const Pair& pair_;
  BufferPool pool_;
  std::unique_ptr<gpu::Executor> executor_;
};

void AddFloors(const gpu::DeviceInfo& device, const SgmSettings& settings, const Pair& pair,
               Figures* figures) {
  const gpu::Frame frame =
      gpu::FrameMemory({.settings = settings}, pair.left.width(), pair.left.height(), nullptr)
          .frame();
  const double cells = static_cast<double>(frame.Pixels()) * settings.num_disparities;
  const int volumes = 1 + (frame.other_costs != nullptr ? 1 : 0) + frame.sum_count;
  const double bytes = 2 * cells * volumes;
  if (device.memory_bytes_per_s > 0) figures->memory_ms = 1e3 * bytes / device.memory_bytes_per_s;
  const double clocks_per_ms = device.clock_hz * device.multiprocessors / 1e3;
  if (clocks_per_ms == 0) return;
  figures->add_ms = 5.5 / 2 * cells * settings.directions / (64 * clocks_per_ms);
  const int code_words = (CensusBytes(settings.census) + 3) / 4;
  figures->count_ms = code_words * cells / (16 * clocks_per_ms);
  figures->chain_ms = 1e3 * 280 * std::max(pair.left.width(), pair.left.height()) / device.clock_hz;
}

Figures Measure(const Options& options, const Pair& pair, const SgmSettings& settings) {
  Figures figures;
  Lane lane(options.device, pair, settings);
  std::vector<double> stages;
  std::vector<double> whole;
  for (int k = 0; k < options.rounds; ++k) {
    const auto begin = Clock::now();
    lane.Frame();
    whole.push_back(MillisecondsSince(begin));
    stages.push_back(static_cast<double>(lane.executor().StagesNs()) / 1e6);
  }
  figures.stages_ms = Median(stages);
  figures.whole_ms = Median(whole);
  figures.device_bytes = lane.executor().DeviceBytes();

  Lane other(options.device, pair, settings);
  const int frames = 4 * options.rounds;
  const auto run = [frames](Lane* one) {
    for (int k = 0; k < frames; ++k) one->Frame();
  };
  const auto begin = Clock::now();
  std::future<void> beside = std::async(std::launch::async, run, &other);
  run(&lane);
  beside.get();
  figures.fps = 2e3 * frames / MillisecondsSince(begin);
  AddFloors((*gpu::Devices())[static_cast<size_t>(options.device)], settings, pair, &figures);
  return figures;
}

void Print(const std::string& name, const Figures& f, bool json) {
  if (json) {
    std::printf("%s\n", nlohmann::json{{"case", name},
                                       {"stages_ms", f.stages_ms},
                                       {"whole_ms", f.whole_ms},
                                       {"fps", f.fps},
                                       {"memory_floor_ms", f.memory_ms},
                                       {"add_floor_ms", f.add_ms},
                                       {"count_floor_ms", f.count_ms},
                                       {"chain_floor_ms", f.chain_ms},
                                       {"device_bytes", f.device_bytes}}
                            .dump()
                            .c_str());
  } else {
    std::printf("%-24s %8.3f %8.3f %8.0f %8.3f %8.3f %8.3f %8.3f %6.0f\n", name.c_str(),
                f.stages_ms, f.whole_ms, f.fps, f.memory_ms, f.add_ms, f.count_ms, f.chain_ms,
                static_cast<double>(f.device_bytes) / 1e6);
  }
  std::fflush(stdout);
}

std::vector<Pair> Pairs(BufferPool& pool) {
  std::vector<Pair> pairs;
  for (const int binning : {2, 1}) {
    const StereoFrame pair = sim::IdealStereo({.binning = binning}).Capture(0, 1, pool);
    const int height = binning == 2 ? 482 : 966;
    const auto cropped = [&](const GreyImage& image) {
      return GreyImage(image.buffer(), image.width(), height, image.stride_bytes());
    };
    pairs.push_back({Str(pair.left->image.width(), "x", height), cropped(pair.left->image),
                     cropped(pair.right->image)});
  }
  return pairs;
}

void MeasureAll(const Options& options) {
  if (!options.json) {
    const gpu::DeviceInfo& device = (*gpu::Devices())[static_cast<size_t>(options.device)];
    std::printf("GPU %d: %s, compute capability %s, driver for CUDA %s\n", options.device,
                device.name.c_str(), device.compute.c_str(), device.driver.c_str());
    std::printf("%-24s %8s %8s %8s %8s %8s %8s %8s %6s\n", "case", "stages", "whole", "fps",
                "memory", "add", "count", "chain", "MB");
  }
  BufferPool pool;
  for (const Pair& pair : Pairs(pool)) {
    for (const int range : {128, 196, 256}) {
      for (const std::string what : {"n1", "n4", "n7", "n8", "quality"}) {
        const std::string name = Str(pair.size, "_d", range, "_", what);
        const bool wanted =
            options.cases.empty() ||
            std::any_of(options.cases.begin(), options.cases.end(), [&](const std::string& part) {
              return name.find(part) != std::string::npos;
            });
        if (!wanted) continue;
        SgmSettings settings =
            what[0] == 'n' ? PlainCensus(what[1] - '0') : ApplySgmPreset(what).value();
        settings.num_disparities = range;
        Print(name, Measure(options, pair, settings), options.json);
      }
    }
  }
}

int Main(int argc, char** argv) {
  Options options;
  CLI::App app("How fast a GPU matches.", "gpu_bench");
  app.add_option("--case", options.cases, "Only cases whose name contains this");
  app.add_option("--device", options.device)->check(CLI::Range(0, 1000))->capture_default_str();
  app.add_option("--rounds", options.rounds)->check(CLI::Range(1, 100000))->capture_default_str();
  app.add_flag("--json", options.json, "One object for each line");
  CLI11_PARSE(app, argc, argv);
  if (!gpu::Devices().has_value()) {
    std::printf("nothing to measure: %s\n", gpu::Devices().error().message().c_str());
    return 0;
  }
  if (const auto executor = gpu::MakeCudaExecutor(options.device, {}); !executor.has_value()) {
    std::fprintf(stderr, "gpu_bench: %s\n", executor.error().ToString().c_str());
    return 1;
  }
  try {
    MeasureAll(options);
  } catch (const std::exception& error) {  // a frame that failed
    std::fprintf(stderr, "gpu_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace vs::test

int main(int argc, char** argv) { return vs::test::Main(argc, argv); }
