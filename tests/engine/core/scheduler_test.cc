#include "engine/core/scheduler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <thread>
#include <vector>

#include "engine/base/mailbox.h"
#include "engine/base/mutex.h"
#include "tests/engine/core/scheduler_fixture.h"

namespace vs {
namespace {

using ::testing::ElementsAre;

// source feeds left and right, both feed join.
SequenceSpec DiamondSpec(const std::string& id) {
  SequenceSpec spec;
  spec.id = id;
  spec.blocks = {SourceSpec("source"), StepSpec("left"), StepSpec("right"), StepSpec("join")};
  spec.connections = {Wire("source.value", "left.a"), Wire("source.value", "right.a"),
                      Wire("left.sum", "join.a"), Wire("right.sum", "join.b")};
  return spec;
}

// A camera as the scheduler sees it: another thread puts pictures into its mailbox.
class LiveSource final : public Block {
 public:
  static LiveSource* started;  // the one that runs

  Out<int64_t> value{this, "value", "What was put."};

  LiveSource() {
    box.OnAvailable([this] { Wake(); });
  }
  Status Start() override {
    started = this;
    return Status();
  }
  bool Ready() override { return box.Available(); }
  Status Run() override {
    value.Set(box.TryTake().value());
    return Status();
  }
  void Stop() override { box.Close(); }
  uint64_t Dropped() const override { return box.Dropped(); }

  Mailbox<int64_t> box;
};
LiveSource* LiveSource::started = nullptr;

VS_REGISTER_BLOCK(LiveSource, {.category = "Test", .doc = "Gives what a test puts."});

// Who ran for which frame, in the order of running.
class Journal {
 public:
  void Note(const std::string& block, uint64_t frame) {
    MutexLock lock(mutex_);
    entries_.push_back(block + " " + std::to_string(frame));
  }
  void Attach(const std::string& block) {
    ProbeOf(block).run = [this, block](const StepRun& run) {
      Note(block, run.frame.number);
      return Status();
    };
  }
  std::vector<std::string> entries() const {
    MutexLock lock(mutex_);
    return entries_;
  }

 private:
  mutable Mutex mutex_;
  std::vector<std::string> entries_ VS_GUARDED_BY(mutex_);
};

TEST_F(SchedulerTest, CarriesEveryFrameThroughEveryBlockInOrder) {
  MakeWorkers(4);
  constexpr int kFrames = 2000;
  LimitFrames("source", kFrames);
  std::atomic<int> wrong = 0;
  for (const char* block : {"left", "right", "join"}) {
    auto last =
        std::make_shared<uint64_t>(0);  // a data race on it would show in the thread sanitizer
    auto inside = std::make_shared<std::atomic<int>>(0);
    ProbeOf(block).run = [&wrong, last, inside](const StepRun& run) {
      if (inside->fetch_add(1) != 0) ++wrong;
      if (run.frame.number != ++*last) ++wrong;
      inside->fetch_sub(1);
      return Status();
    };
  }
  SequenceSpec spec = DiamondSpec("diamond");
  spec.max_frames_in_flight = 8;
  const auto run = Start(spec);
  ASSERT_TRUE(WaitForFrames(*run, kFrames));
  run->Stop();
  EXPECT_EQ(wrong, 0);
  for (const BlockStats& block : run->Stats().blocks) EXPECT_EQ(block.runs, 2000u) << block.id;
}

TEST_F(SchedulerTest, GivesTheSameResultsWithOneAndWithTwoWorkers) {
  std::vector<std::vector<int64_t>> results;
  for (const int workers : {1, 2}) {
    MakeWorkers(workers);
    LimitFrames("source", 300);
    std::vector<int64_t> sums;
    ProbeOf("join").run = [&sums](const StepRun& run) {
      sums.push_back(run.a * 1000 + *run.b);
      return Status();
    };
    SequenceSpec spec = DiamondSpec("diamond");
    spec.blocks[1].params["offset"] = int64_t{3};
    const auto run = Start(spec);
    ASSERT_TRUE(WaitForFrames(*run, 300));
    run->Stop();
    results.push_back(sums);
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0][299], 303'300);
}

TEST_F(SchedulerTest, RunsIndependentBranchesInParallel) {
  MakeWorkers(2);
  LimitFrames("source", 1);
  Gate left_is_in;
  Gate right_is_in;
  std::atomic<int> met = 0;
  ProbeOf("left").run = [&](const StepRun&) {
    left_is_in.Open();
    met += right_is_in.Wait();
    return Status();
  };
  ProbeOf("right").run = [&](const StepRun&) {
    right_is_in.Open();
    met += left_is_in.Wait();
    return Status();
  };
  const auto run = Start(DiamondSpec("diamond"));
  ASSERT_TRUE(WaitForFrames(*run, 1));
  EXPECT_EQ(met, 2);
}

TEST_F(SchedulerTest, FinishesWhatIsBegunBeforeItLetsAFrameIn) {
  MakeWorkers(1);
  Journal journal;
  for (const char* block : {"one", "two"}) journal.Attach(block);
  std::atomic<int64_t> given = 0;
  ProbeOf("source").ready = [&given] { return given < 2; };
  ProbeOf("source").run = [&](const StepRun& run) {
    given = run.a;
    journal.Note("source", run.frame.number);
    return Status();
  };
  const auto run = Start(ChainSpec("line", {"one", "two"}));
  ASSERT_TRUE(WaitForFrames(*run, 2));
  EXPECT_THAT(journal.entries(),
              ElementsAre("source 1", "one 1", "two 1", "source 2", "one 2", "two 2"));
}

TEST_F(SchedulerTest, PrefersTheSequenceOfHigherPriority) {
  MakeWorkers(1);
  Gate busy;
  Gate release;
  LimitFrames("holder", 1);
  SequenceSpec holding;
  holding.id = "holding";
  holding.blocks = {SourceSpec("holder")};
  const auto limited = ProbeOf("holder").run;
  ProbeOf("holder").run = [&, limited](const StepRun& run) {
    busy.Open();
    release.Wait();
    return limited(run);
  };
  const auto holder = Start(holding);
  ASSERT_TRUE(busy.Wait());

  Journal journal;
  std::vector<std::shared_ptr<vs::Run>> runs;
  for (const int priority : {-1, 1, 0}) {
    const std::string name = "p" + std::to_string(priority + 1);
    SequenceSpec spec = ChainSpec(name, {name + "_step"});
    spec.priority = priority;
    spec.blocks[0].params["probe"] = name;
    LimitFrames(name, 2);
    journal.Attach(name + "_step");
    runs.push_back(Start(spec));
  }
  release.Open();
  for (const auto& run : runs) ASSERT_TRUE(WaitForFrames(*run, 2));
  EXPECT_THAT(journal.entries(), ElementsAre("p2_step 1", "p2_step 2", "p1_step 1", "p1_step 2",
                                             "p0_step 1", "p0_step 2"));
}

TEST_F(SchedulerTest, LetsSequencesOfEqualPriorityTakeTurns) {
  MakeWorkers(1);  // and both sources always have a frame
  const auto near = Start(ChainSpec("near", {"a"}));
  const auto far = Start(ChainSpec("far", {"b", "c", "d", "e", "f", "g", "h"}));
  ASSERT_TRUE(WaitForFrames(*near, 100));
  ASSERT_TRUE(WaitForFrames(*far, 100));
}

TEST_F(SchedulerTest, LetsNoMoreFramesInThanAllowed) {
  MakeWorkers(4);
  Gate release;
  std::atomic<int64_t> entered = 0;
  ProbeOf("source").run = [&](const StepRun& run) {
    entered = run.a;
    return Status();
  };
  ProbeOf("slow").run = [&](const StepRun&) {
    release.Wait();
    return Status();
  };
  SequenceSpec spec = ChainSpec("line", {"slow"});
  spec.max_frames_in_flight = 3;
  const auto run = Start(spec);
  ASSERT_TRUE(WaitUntil([&] { return entered == 3; }));
  // Workers are free and the source is ready: another sequence gets through, a fourth frame not.
  const auto other = Start(ChainSpec("other", {"step"}));
  ASSERT_TRUE(WaitForFrames(*other, 100));
  EXPECT_EQ(run->Stats().frames_in_flight, 3);
  release.Open();
  ASSERT_TRUE(WaitForFrames(*run, 10));
}

TEST_F(SchedulerTest, TakesTheNewestPictureAndCountsThoseItHadNoTimeFor) {
  MakeWorkers(2);
  Gate busy;
  Gate release;
  std::vector<int64_t> seen;
  ProbeOf("slow").run = [&](const StepRun& run) {
    busy.Open();
    release.Wait();
    seen.push_back(run.a);
    return Status();
  };
  SequenceSpec spec;
  spec.id = "live";
  spec.max_frames_in_flight = 1;
  spec.blocks = {{"camera", "LiveSource", {}}, StepSpec("slow")};
  spec.connections = {Wire("camera.value", "slow.a")};
  const auto run = Start(spec);
  LiveSource::started->box.Put(1);
  ASSERT_TRUE(busy.Wait());
  for (int64_t picture = 2; picture <= 6; ++picture) LiveSource::started->box.Put(picture);
  EXPECT_EQ(run->Stats().dropped, 4u);
  release.Open();
  ASSERT_TRUE(WaitForFrames(*run, 2));
  run->Stop();
  EXPECT_THAT(seen, ElementsAre(1, 6));
  EXPECT_EQ(run->Stats().frames, 2u);
  EXPECT_EQ(run->Stats().dropped, 4u);
}

TEST_F(SchedulerTest, AsksASourceAgainWhenItCalls) {
  MakeWorkers(2);
  std::atomic<int> available = 0;
  std::function<void()> wake;
  ProbeOf("source").ready = [&] { return available > 0; };
  ProbeOf("source").run = [&](const StepRun&) {
    --available;
    return Status();
  };
  ProbeOf("source").take_wake = [&](std::function<void()> call) { wake = std::move(call); };
  const auto run = Start(ChainSpec("line", {"step"}));
  for (uint64_t frame = 1; frame <= 500; ++frame) {
    ++available;
    wake();
    ASSERT_TRUE(WaitForFrames(*run, frame));
  }
  EXPECT_EQ(run->Stats().frames, 500u);
}

TEST_F(SchedulerTest, LetsAFrameInOnlyWhenEverySourceIsReady) {
  MakeWorkers(2);
  SequenceSpec spec;
  spec.id = "two";
  spec.blocks = {SourceSpec("first"), SourceSpec("second"), StepSpec("sum")};
  spec.connections = {Wire("first.value", "sum.a"), Wire("second.value", "sum.b")};
  LimitFrames("first", 5);
  LimitFrames("second", 3);
  std::vector<int64_t> sums;
  ProbeOf("sum").run = [&](const StepRun& run) {
    sums.push_back(run.a + *run.b);
    return Status();
  };
  const auto run = Start(spec);
  ASSERT_TRUE(WaitForFrames(*run, 3));
  run->Stop();
  EXPECT_THAT(sums, ElementsAre(2, 4, 6));
  EXPECT_EQ(run->Stats().frames, 3u);
  EXPECT_EQ(run->Stats().dropped, 14u) << "7 of each source";
}

TEST_F(SchedulerTest, TellsEachFrameWhereItIs) {
  MakeWorkers(1);
  LimitFrames("source", 2);
  std::vector<FrameContext> seen;
  ProbeOf("step").run = [&](const StepRun& run) {
    seen.push_back(run.frame);
    return Status();
  };
  const auto run = Start(ChainSpec("line", {"step"}));
  ASSERT_TRUE(WaitForFrames(*run, 2));
  run->Stop();
  EXPECT_EQ(seen[1].run->sequence, "line");
  EXPECT_EQ(seen[1].run->sequence_revision, 1u);
  EXPECT_THAT(seen[1].run->block_ids, ElementsAre("source", "step"));
  EXPECT_EQ(seen[1].number, 2u);
  EXPECT_GT(seen[1].popped_ns, 0);
  EXPECT_GE(seen[1].block_times[0].start_ns, seen[1].popped_ns);
  EXPECT_EQ(seen[1].block_times[1].end_ns, 0) << "still at work";
  EXPECT_EQ(seen[1].parameter_hash, HashParameters(run->Parameters()));
}

TEST_F(SchedulerTest, LetsFramesGoBeforeOtherPrograms) {
  const int own = getpriority(PRIO_PROCESS, 0);
  bool may = false;
  std::thread([&] { may = setpriority(PRIO_PROCESS, gettid(), own - 5) == 0; }).join();
  if (!may) GTEST_SKIP() << "may not raise priorities; run this test as root";
  MakeWorkers(1);
  LimitFrames("source", 1);
  int niceness = 0;
  ProbeOf("step").run = [&](const StepRun&) {
    niceness = getpriority(PRIO_PROCESS, gettid());
    return Status();
  };
  const auto run = Start(ChainSpec("line", {"step"}));
  ASSERT_TRUE(WaitForFrames(*run, 1));
  run->Stop();
  EXPECT_EQ(niceness, std::max(own - 5, -20));
  EXPECT_EQ(getpriority(PRIO_PROCESS, 0), own) << "the server's other threads stay as they are";
}

}  // namespace
}  // namespace vs
