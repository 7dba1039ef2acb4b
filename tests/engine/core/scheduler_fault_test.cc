#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>
#include <vector>

#include "engine/base/mutex.h"
#include "engine/core/scheduler.h"
#include "tests/engine/core/scheduler_fixture.h"

namespace vs {
namespace {

using ::testing::ElementsAre;

class SchedulerFaultTest : public SchedulerTest {
 protected:
  // Notes in `calls_` when these blocks start and stop.
  void Watch(const std::vector<std::string>& blocks) {
    for (const std::string& block : blocks) {
      ProbeOf(block).start = [this, block] {
        MutexLock lock(mutex_);
        calls_.push_back("start " + block);
        return Status();
      };
      ProbeOf(block).stop = [this, block] {
        MutexLock lock(mutex_);
        calls_.push_back("stop " + block);
      };
    }
  }
  std::vector<std::string> calls() {
    MutexLock lock(mutex_);
    return calls_;
  }

  Mutex mutex_;
  std::vector<std::string> calls_ VS_GUARDED_BY(mutex_);
};

TEST_F(SchedulerFaultTest, AnErrorSkipsWhatIsBehindItForThisFrame) {
  MakeWorkers(2);
  LimitFrames("source", 4);
  ProbeOf("bad").run = [](const StepRun& run) {
    return run.frame.number == 2 ? InvalidArgument("too dark") : Status();
  };
  SequenceSpec spec = ChainSpec("line", {"bad", "behind"});
  spec.blocks.push_back(StepSpec("beside"));
  spec.blocks.push_back({"some", "TestSome", {}});
  spec.connections.push_back(Wire("source.value", "beside.a"));
  spec.connections.push_back(Wire("bad.sum", "some.a"));
  spec.connections.push_back(Wire("beside.sum", "some.b"));
  const auto run = Start(spec);
  ASSERT_TRUE(WaitForFrames(*run, 4));
  const RunStats stats = run->Stats();
  EXPECT_EQ(stats.state, RunState::kRunning);
  EXPECT_EQ(stats.failed_frames, 1u);
  EXPECT_EQ(stats.last_error, "") << "the last frame was good";
  ASSERT_EQ(stats.blocks.size(), 5u);
  std::vector<std::string> counts;
  for (const BlockStats& block : stats.blocks) {
    counts.push_back(block.id + " " + std::to_string(block.runs) + " " +
                     std::to_string(block.skipped) + " " + std::to_string(block.errors));
  }
  EXPECT_EQ(stats.blocks[1].last_error, "") << "its last run was good";
  EXPECT_EQ(stats.blocks[1].last_failure, "too dark");
  EXPECT_EQ(stats.blocks[2].last_failure, "");
  // id, runs, skipped, errors; "some" needs only one of its inputs.
  EXPECT_THAT(counts, ElementsAre("source 4 0 0", "bad 4 0 1", "behind 3 1 0", "beside 4 0 0",
                                  "some 4 0 0"));
}

TEST_F(SchedulerFaultTest, TellsWhyASourceIsSilent) {
  MakeWorkers(1);
  ProbeOf("source").ready = [] { return false; };
  ProbeOf("source").report = [] {
    return SourceReport{"no pictures come", {{"lost", int64_t{3}}}};
  };
  const auto run = Start(ChainSpec("line", {"step"}));
  const RunStats stats = run->Stats();
  EXPECT_EQ(stats.state, RunState::kRunning);
  EXPECT_EQ(stats.last_error, "source: no pictures come");
  EXPECT_EQ(stats.blocks[0].last_error, "no pictures come");
  EXPECT_THAT(stats.blocks[0].readings, ElementsAre(Reading{"lost", int64_t{3}}));
  EXPECT_TRUE(stats.blocks[1].readings.empty());
}

TEST_F(SchedulerFaultTest, AFailedRunHasTheFirstWordBeforeASourcesProblem) {
  MakeWorkers(1);
  LimitFrames("source", 1);
  ProbeOf("source").report = [] { return SourceReport{"few pictures come", {}}; };
  ProbeOf("bad").run = [](const StepRun&) { return InvalidArgument("too dark"); };
  const auto run = Start(ChainSpec("line", {"bad"}));
  ASSERT_TRUE(WaitForFrames(*run, 1));
  EXPECT_EQ(run->Stats().last_error, "bad: too dark");
  EXPECT_EQ(run->Stats().blocks[0].last_error, "few pictures come");
}

TEST_F(SchedulerFaultTest, NamesTheBlockOfTheLastError) {
  MakeWorkers(1);
  LimitFrames("source", 1);
  ProbeOf("bad").run = [](const StepRun&) { return InvalidArgument("too dark"); };
  const auto run = Start(ChainSpec("line", {"bad"}));
  ASSERT_TRUE(WaitForFrames(*run, 1));
  EXPECT_EQ(run->Stats().last_error, "bad: too dark");
  EXPECT_EQ(run->Stats().blocks[1].last_error, "too dark");
}

TEST_F(SchedulerFaultTest, AnExceptionEndsItsRunAndNoOther) {
  MakeWorkers(2);
  Watch({"bad", "behind"});
  ProbeOf("bad").run = [](const StepRun& run) -> Status {
    if (run.frame.number == 3) throw std::runtime_error("boom");
    return Status();
  };
  SequenceSpec spec = ChainSpec("faulty", {"bad", "behind"});
  spec.max_frames_in_flight = 4;
  const auto faulty = Start(spec);
  const auto other = Start(ChainSpec("other", {"step"}));
  ASSERT_TRUE(WaitUntil([&] { return faulty->Stats().state == RunState::kFault; }));
  EXPECT_EQ(faulty->Stats().last_error, "bad: exception: boom");
  // Nobody called Stop(), yet the blocks are stopped.
  ASSERT_TRUE(WaitUntil([&] { return calls().size() == 4; }));
  EXPECT_THAT(calls(), ElementsAre("start behind", "start bad", "stop bad", "stop behind"));

  const uint64_t frames = other->Stats().frames;
  ASSERT_TRUE(WaitForFrames(*other, frames + 100));
  EXPECT_EQ(other->Stats().state, RunState::kRunning);

  faulty->Stop();
  EXPECT_EQ(faulty->Stats().state, RunState::kFault) << "why it ended stays visible";
  EXPECT_EQ(faulty->Stats().frames_in_flight, 0);
  EXPECT_EQ(calls().size(), 4u);
}

TEST_F(SchedulerFaultTest, AnExceptionOfReadyIsAFaultToo) {
  MakeWorkers(1);
  ProbeOf("source").ready = []() -> bool { throw std::runtime_error("no sensor"); };
  const auto run = Start(ChainSpec("line", {"step"}));
  ASSERT_TRUE(WaitUntil([&] { return run->Stats().state == RunState::kFault; }));
  EXPECT_EQ(run->Stats().last_error, "source: exception: no sensor");
}

TEST_F(SchedulerFaultTest, TheFirstOfTwoExceptionsIsTheOneThatIsTold) {
  MakeWorkers(2);
  Gate asked;
  Gate faulted;
  std::atomic<int> questions = 0;
  ProbeOf("source").ready = [&] {
    if (++questions == 1) return true;
    asked.Open();
    faulted.Wait();
    throw std::runtime_error("no sensor");
  };
  ProbeOf("bad").run = [&](const StepRun&) -> Status {
    asked.Wait();
    throw std::runtime_error("boom");
  };
  const auto run = Start(ChainSpec("line", {"bad"}));
  ASSERT_TRUE(WaitUntil([&] { return run->Stats().state == RunState::kFault; }));
  faulted.Open();
  run->Stop();
  EXPECT_EQ(questions, 2);
  EXPECT_EQ(run->Stats().last_error, "bad: exception: boom");
}

TEST_F(SchedulerFaultTest, StartsTowardsTheSourcesAndStopsFromThem) {
  MakeWorkers(2);
  Watch({"source", "one", "two"});
  LimitFrames("source", 3);
  const auto run = Start(ChainSpec("line", {"one", "two"}));
  ASSERT_TRUE(WaitForFrames(*run, 3));
  run->Stop();
  run->Stop();
  EXPECT_THAT(calls(), ElementsAre("start two", "start one", "start source", "stop source",
                                   "stop one", "stop two"));
  EXPECT_EQ(run->Stats().state, RunState::kStopped);
  EXPECT_EQ(run->Stats().frames, 3u);
}

TEST_F(SchedulerFaultTest, AFailedStartStopsEverythingAgain) {
  MakeWorkers(1);
  Watch({"source", "one", "two"});
  ProbeOf("one").start = [] { return NotFound("no model of this name"); };
  const auto run = TryStart(ChainSpec("line", {"one", "two"}));
  ASSERT_FALSE(run.has_value());
  EXPECT_EQ(run.error(), NotFound("one: no model of this name"));
  EXPECT_THAT(calls(), ElementsAre("start two", "stop source", "stop one", "stop two"));

  ProbeOf("one").start = []() -> Status { throw std::runtime_error("boom"); };
  EXPECT_EQ(TryStart(ChainSpec("line", {"one"})).error(), Internal("one: exception: boom"));
}

TEST_F(SchedulerFaultTest, StopsUnderLoadAtAnyMoment) {
  MakeWorkers(3);
  for (int round = 0; round < 60; ++round) {
    std::atomic<bool> stopped = false;
    std::atomic<int> late = 0;
    for (const char* block : {"one", "two"}) {
      ProbeOf(block).run = [&](const StepRun&) {
        if (stopped) ++late;
        return Status();
      };
    }
    SequenceSpec spec = ChainSpec("line", {"one", "two"});
    spec.max_frames_in_flight = 1 + round % 4;
    const auto run = Start(spec);
    ASSERT_TRUE(WaitForFrames(*run, round % 5));
    std::thread also([&run] { run->Stop(); });
    run->Stop();
    stopped = true;
    const RunStats stats = run->Stats();
    EXPECT_EQ(stats.state, RunState::kStopped);
    EXPECT_EQ(stats.frames_in_flight, 0);
    EXPECT_EQ(stats.blocks[2].runs, stats.frames) << "frames in flight complete";
    also.join();
    EXPECT_EQ(late, 0);
  }
}

TEST_F(SchedulerFaultTest, StopsWhileASourceWaits) {
  MakeWorkers(1);
  ProbeOf("source").ready = [] { return false; };
  const auto run = Start(ChainSpec("line", {"one"}));
  run->Stop();
  EXPECT_EQ(run->Stats().state, RunState::kStopped);
  EXPECT_EQ(run->Stats().frames, 0u);
}

TEST_F(SchedulerFaultTest, StopsWhileSourcesCallFromTheirThreads) {
  MakeWorkers(2);
  for (int round = 0; round < 30; ++round) {
    std::atomic<bool> calling = true;
    std::thread camera;
    ProbeOf("source").take_wake = [&](const std::function<void()>& wake) {
      camera = std::thread([&calling, wake] {
        while (calling) wake();
      });
    };
    ProbeOf("source").stop = [&] {
      calling = false;
      if (camera.joinable()) camera.join();
    };
    const auto run = Start(ChainSpec("line", {"one"}));
    ASSERT_TRUE(WaitForFrames(*run, 3));
    run->Stop();
  }
}

TEST_F(SchedulerFaultTest, DroppingTheLastHandleStopsTheRun) {
  MakeWorkers(2);
  Watch({"source"});
  auto run = Start(ChainSpec("line", {"one"}));
  run.reset();
  EXPECT_THAT(calls(), ElementsAre("start source", "stop source"));
}

TEST_F(SchedulerFaultTest, ARunMayOutliveItsScheduler) {
  MakeWorkers(2);
  Watch({"source"});
  const auto run = Start(ChainSpec("line", {"one"}));
  ASSERT_TRUE(WaitForFrames(*run, 1));
  scheduler_.reset();
  EXPECT_THAT(calls(), ElementsAre("start source", "stop source"));
  EXPECT_EQ(run->Stats().state, RunState::kStopped);
  run->Stop();
  EXPECT_EQ(run->SetParameters({}).error().code(), StatusCode::kFailedPrecondition);
}

}  // namespace
}  // namespace vs
