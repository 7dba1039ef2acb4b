#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "engine/base/clock.h"
#include "engine/core/scheduler.h"
#include "tests/engine/core/test_blocks.h"
#include "tests/support/wait_until.h"

namespace vs {

using test::WaitUntil;

// A door that is shut until Open(). Whoever waits gives up after a minute.
class Gate {
 public:
  void Open() { open_ = true; }
  bool Wait() const {
    return WaitUntil([this] { return open_.load(); });
  }

 private:
  std::atomic<bool> open_ = false;
};

class SchedulerTest : public ::testing::Test {
 protected:
  ~SchedulerTest() override {
    scheduler_.reset();
    ClearProbes();
  }

  void MakeWorkers(int count) { scheduler_ = std::make_unique<Scheduler>(count, clock_); }

  Result<std::shared_ptr<vs::Run>> TryStart(const SequenceSpec& spec) {
    auto sequence = Sequence::Load(spec, 1);
    if (!sequence.has_value()) return sequence.error();
    return scheduler_->Start(std::move(*sequence), Environment{&clock_});
  }
  std::shared_ptr<vs::Run> Start(const SequenceSpec& spec) {
    auto run = TryStart(spec);
    if (!run.has_value()) throw std::runtime_error(run.error().ToString());
    return *run;
  }

  // Lets the source of this name give so many frames and no more.
  static void LimitFrames(const std::string& source, int64_t frames) {
    Probe& probe = ProbeOf(source);
    auto given = std::make_shared<std::atomic<int64_t>>(0);
    probe.ready = [given, frames] { return *given < frames; };
    probe.run = [given](const StepRun& run) {
      *given = run.a;
      return Status();
    };
  }
  static bool WaitForFrames(const vs::Run& run, uint64_t frames) {
    return WaitUntil([&] { return run.Stats().frames >= frames; });
  }

  const SystemClock clock_{};
  std::unique_ptr<Scheduler> scheduler_;
};

}  // namespace vs
