// What the scheduler costs for each block of each frame, with blocks that do nothing:
//   chain   source -> b -> b -> ... one after the other
//   fan     source -> n blocks side by side
// The figure to read is us_per_block: wall time of a frame divided by its blocks.
#include <benchmark/benchmark.h>

#include <atomic>
#include <string>
#include <thread>

#include "engine/base/clock.h"
#include "engine/core/scheduler.h"

namespace vs {
namespace {

std::atomic<int64_t> frames_done = 0;

class BenchSource final : public Block {
 public:
  Out<int64_t> value{this, "value", "The frame's number."};
  Status Run() override {
    value.Set(static_cast<int64_t>(frame().number));
    frames_done.store(static_cast<int64_t>(frame().number), std::memory_order_relaxed);
    return Status();
  }
};

class BenchStep final : public Block {
 public:
  In<int64_t> in{this, "in", "A number."};
  Out<int64_t> out{this, "out", "The same number."};
  Status Run() override {
    out.Set(*in);
    return Status();
  }
};

VS_REGISTER_BLOCK(BenchSource, {.category = "Test", .doc = "Counts frames."});
VS_REGISTER_BLOCK(BenchStep, {.category = "Test", .doc = "Hands a number on."});

SequenceSpec Spec(int64_t steps, bool chain) {
  SequenceSpec spec;
  spec.id = "bench";
  spec.blocks = {{"source", "BenchSource", {}}};
  for (int64_t i = 0; i < steps; ++i) {
    const std::string id = "b" + std::to_string(i);
    spec.blocks.push_back({id, "BenchStep", {}});
    const bool first = i == 0 || !chain;
    spec.connections.push_back(
        {first ? "source" : "b" + std::to_string(i - 1), first ? "value" : "out", id, "in"});
  }
  return spec;
}

void WaitFor(int64_t frames) {
  while (frames_done.load(std::memory_order_relaxed) < frames) {
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
}

void Measure(benchmark::State& state, bool chain) {
  const int64_t steps = state.range(0);
  const SystemClock clock;
  Scheduler scheduler(static_cast<int>(state.range(1)), clock);
  frames_done = 0;
  const auto run =
      scheduler.Start(Sequence::Load(Spec(steps, chain), 1).value(), Environment{&clock}).value();
  WaitFor(1000);  // warm
  int64_t frames = 0;
  int64_t elapsed_ns = 0;
  for (auto unused : state) {
    const int64_t from = frames_done;
    const int64_t start_ns = clock.MonotonicNs();
    WaitFor(from + 2000);
    const int64_t took_ns = clock.MonotonicNs() - start_ns;
    frames += frames_done - from;
    elapsed_ns += took_ns;
    state.SetIterationTime(static_cast<double>(took_ns) * 1e-9);
  }
  run->Stop();
  state.counters["us_per_block"] =
      static_cast<double>(elapsed_ns) * 1e-3 / static_cast<double>(frames * (steps + 1));
}

void Chain(benchmark::State& state) { Measure(state, true); }
void Fan(benchmark::State& state) { Measure(state, false); }

BENCHMARK(Chain)
    ->ArgNames({"blocks", "workers"})
    ->ArgsProduct({{1, 4, 16, 64}, {1, 2}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Fan)
    ->ArgNames({"blocks", "workers"})
    ->ArgsProduct({{4, 16, 64}, {1, 2}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vs

BENCHMARK_MAIN();
